/** @import { Door } from "./door.js" */
/** @import { LiveExtent } from "./extent.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { CameraPose, Matrix4, Vector3 } from "./viser.d.ts" */

const FILL = 2 / 3;
const FOCUS_FILL = 0.45;
/** Long enough a lens that round things at the border stay round. */
const FIELD_OF_VIEW_DEG = 42;
const NEAREST_M = 0.05;
/** Around what may be as small as a point. */
const ROOM_M = 0.1;
const SMOOTH_S = 0.18;
/** After so long, and so many pictures, without another mesh the robot is there, and what an edit
 * adds moves no camera. */
const ARRIVED = { ms: 5000, pictures: 10 };

/** From the target towards the eye, in the root frame; top is tipped so that x points right.
 * @type {Record<string, [number, number, number]>} */
const DIRECTIONS = {
  front: [1, 0, 0],
  back: [-1, 0, 0],
  left: [0, 1, 0],
  right: [0, -1, 0],
  top: [0, -0.001, 1],
  bottom: [0, -0.001, -1],
  iso: [1, -0.8, 0.62],
};

/** This browser's own camera: fits, turns to views, and is left alone by all that the server does. */
export class CameraView {
  #door;
  #robot;
  #live;
  #untouched = true;
  /** Width by height of the picture. */
  #aspect = 0;
  /** The most meshes that stood in the scene at once. */
  #meshes = 0;
  #lastArrival_ms = 0;
  #picturesSince = 0;
  /** Where the eye was put when the robot arrived; null: it was moved since. @type {Vector3 | null} */
  #arrivedAt = null;
  #usualSmoothTime = 0;
  /** @type {"rviz" | "trackpad"} */
  #mouse = "rviz";
  /** @type {object | null} The control that has these buttons: viser may make another. */
  #mouseOf = null;

  /** @param {Door} door @param {RobotView} robot @param {LiveExtent} live */
  constructor(door, robot, live) {
    this.#door = door;
    this.#robot = robot;
    this.#live = live;
    door.onPicture(() => {
      if (this.#control() !== this.#mouseOf) this.setMouse(this.#mouse);
      this.#keepInPicture();
      this.#fitWhileMeshesArrive();
    });
    door.ready.then(({ camera }) => {
      if (!camera) return;
      camera.fov = FIELD_OF_VIEW_DEG;
      camera.updateProjectionMatrix();
    });
  }

  /** A hand on the camera ends the fitting by itself. */
  touched() {
    this.#untouched = false;
    const control = this.#control();
    if (control && this.#usualSmoothTime) control.smoothTime = this.#usualSmoothTime;
  }

  /** Show all that is drawn from where we look. @param {boolean} [animate] */
  fit(animate = true) {
    const corners = [...this.#robot.corners(), ...this.#live.corners()];
    this.#look(corners, this.#direction(), FILL, animate);
  }

  /** Show the whole robot from one side. @param {string} name @param {boolean} [animate] */
  view(name, animate = true) {
    const direction = DIRECTIONS[name];
    if (!direction) throw new RangeError(`There is no view "${name}".`);
    this.#untouched = false;
    this.#look(this.#robot.corners(), this.#inScene(direction), FILL, animate);
  }

  /** Bring one link to the middle. @param {string} link */
  focus(link) {
    const corners = this.#robot.corners([link]);
    this.#untouched = false;
    this.#look(corners.length ? corners : this.#around(link), this.#direction(), FOCUS_FILL, true);
  }

  /** Bring points of the scene to the middle, with some room around them. @param {Vector3[]} points */
  focusOn(points) {
    const [first] = points;
    if (!first) return;
    this.#untouched = false;
    const aside = first.clone().set(ROOM_M, ROOM_M, ROOM_M);
    const around = points.flatMap((one) => [one.clone().add(aside), one.clone().sub(aside)]);
    this.#look(around, this.#direction(), FOCUS_FILL, true);
  }

  /** Bring a place of the scene to the middle, from the same side and as far away.
   * @param {Vector3} place */
  lookAt(place) {
    const control = this.#control();
    if (!control) return;
    this.#untouched = false;
    const eye = control.getPosition(this.#vector()).sub(control.getTarget(this.#vector()));
    this.#move(eye.add(place), place, true);
  }

  /** Move as something in the scene moved, in this very picture; what the camera is about to do it
   * goes on doing. @param {Vector3} way */
  carry(way) {
    const [camera, control] = [this.#door.mutable?.camera, this.#control()];
    if (!camera || !control) return;
    this.#arrivedAt = null;
    const now = control.getTarget(this.#vector(), false).add(way);
    const soon = control.getTarget(this.#vector()).add(way);
    control.moveTo(now.x, now.y, now.z, false);
    control.moveTo(soon.x, soon.y, soon.z, true);
    camera.position.add(way);
    camera.updateWorldMatrix(false, false);
    this.#door.redraw();
  }

  /** @returns {CameraPose | null} */
  get() {
    const [control, root] = [this.#control(), this.#rootMatrix()];
    if (!control || !root) return null;
    const back = root.clone().invert();
    const point = (/** @type {Vector3} */ vector) => toTriple(vector.applyMatrix4(back));
    return {
      position: point(control.getPosition(this.#vector())),
      target: point(control.getTarget(this.#vector())),
    };
  }

  /** A place of the scene in the root frame. @param {Vector3} place @returns {[number, number, number] | null} */
  inRoot(place) {
    const root = this.#rootMatrix();
    return root && toTriple(place.clone().applyMatrix4(root.clone().invert()));
  }

  /** A place in the root frame, in the scene. @param {readonly [number, number, number]} place @returns {Vector3 | null} */
  fromRoot(place) {
    const root = this.#rootMatrix();
    return root && this.#vector(...place).applyMatrix4(root);
  }

  /** @param {CameraPose} pose @param {boolean} [animate] */
  set(pose, animate = false) {
    const root = this.#rootMatrix();
    if (!root) return;
    this.#untouched = false;
    const eye = this.#vector(...pose.position).applyMatrix4(root);
    this.#move(eye, this.#vector(...pose.target).applyMatrix4(root), animate);
  }

  /** `rviz`: left orbits, middle (or Shift and left) pans, right or wheel zooms; `trackpad`: left
   * orbits, right pans, wheel zooms. @param {"rviz" | "trackpad"} mode */
  setMouse(mode) {
    this.#mouse = mode;
    const control = this.#control();
    this.#mouseOf = control;
    if (!control) return;
    const { ROTATE = 1, TRUCK = 2, DOLLY = 16 } = control.constructor.ACTION;
    const right = mode === "trackpad" ? TRUCK : DOLLY;
    Object.assign(control.mouseButtons, { left: ROTATE, middle: TRUCK, right, wheel: DOLLY });
  }

  /** Distance from the eye to what it looks at, m. */
  distance() {
    const control = this.#control();
    if (!control) return 1;
    return control.getPosition(this.#vector()).distanceTo(control.getTarget(this.#vector()));
  }

  /** A picture of another shape shows at least as much: what was seen along its shorter side stays seen. */
  #keepInPicture() {
    const [camera, control] = [this.#door.mutable?.camera, this.#control()];
    const { innerWidth: width, innerHeight: height } = window;
    if (!camera || !control || !width || !height) return;
    const before = this.#aspect;
    this.#aspect = width / height;
    if (!before || before === this.#aspect) return;
    if (this.#isArriving()) {
      this.#fitArrived(this.#direction());
      return;
    }
    const farther = Math.min(1, before) / Math.min(1, this.#aspect);
    const target = control.getTarget(this.#vector());
    const eye = control.getPosition(this.#vector()).sub(target).multiplyScalar(farther);
    if (farther !== 1) this.#move(eye.add(target), target, false);
  }

  /** An edit that makes a mesh anew, or a hand that hides one, leaves the camera alone. */
  #fitWhileMeshesArrive() {
    if (!this.#isArriving() || !this.#control()) return;
    this.#picturesSince += 1;
    const meshes = this.#robot.meshCount();
    const isReset = this.#isReset();
    if (meshes <= this.#meshes && !isReset) return;
    const first = this.#meshes === 0 || isReset;
    this.#meshes = Math.max(meshes, this.#meshes);
    this.#lastArrival_ms = performance.now();
    this.#picturesSince = 0;
    this.#fitArrived(first ? this.#inScene(DIRECTIONS.iso ?? [1, 0, 0]) : this.#direction());
    document.documentElement.dataset.drawn = "";
  }

  #isArriving() {
    if (!this.#untouched || this.#meshes === 0) return this.#untouched;
    const rest_ms = performance.now() - this.#lastArrival_ms;
    return rest_ms < ARRIVED.ms || this.#picturesSince < ARRIVED.pictures;
  }

  /** viser puts the camera at its own place when its scene stands, which may be after the robot. */
  #isReset() {
    const now = this.#arrivedAt && this.#control()?.getPosition(this.#vector());
    return Boolean(now && this.#arrivedAt && now.distanceTo(this.#arrivedAt) > NEAREST_M / 10);
  }

  /** @param {Vector3} direction */
  #fitArrived(direction) {
    this.#look(this.#robot.corners(this.#robot.drawn), direction, FILL, false);
    this.#arrivedAt = this.#control()?.getPosition(this.#vector()) ?? null;
  }

  /** Look at points so that they fill a part of the picture and lie in its middle.
   * @param {Vector3[]} points @param {Vector3} direction @param {number} fill @param {boolean} animate */
  #look(points, direction, fill, animate) {
    const camera = this.#door.mutable?.camera;
    const [first] = points;
    if (!camera || !first) return;
    const right = camera.up.clone().cross(direction).normalize();
    const up = direction.clone().cross(right);
    const tall = Math.tan((camera.fov * Math.PI) / 360) * fill;
    const target = middle(points);
    let distance = NEAREST_M;
    // What is nearer looks larger, so that the middle of the picture is found in a few steps.
    for (let step = 0; step < 4; step++) {
      const seen = points.map((point) => {
        const from = point.clone().sub(target);
        return { x: from.dot(right) / camera.aspect, y: from.dot(up), z: from.dot(direction) };
      });
      const reach = seen.map(({ x, y, z }) => z + Math.max(Math.abs(x), Math.abs(y)) / tall);
      distance = Math.max(NEAREST_M, ...reach);
      const shift = (/** @type {"x" | "y"} */ side) => {
        const places = seen.map((point) => point[side] / (distance - point.z));
        return ((Math.min(...places) + Math.max(...places)) / 2) * distance;
      };
      target.addScaledVector(right, shift("x") * camera.aspect).addScaledVector(up, shift("y"));
    }
    this.#move(target.clone().addScaledVector(direction, distance), target, animate);
  }

  /** @param {Vector3} eye @param {Vector3} target @param {boolean} animate */
  #move(eye, target, animate) {
    const control = this.#control();
    if (!control) return;
    this.#arrivedAt = null;
    this.#usualSmoothTime ||= control.smoothTime;
    if (animate && !matchMedia("(prefers-reduced-motion: reduce)").matches) {
      control.smoothTime = SMOOTH_S;
      control.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, true);
    } else {
      // One after the other: viser found that setLookAt without animation spoils later ones.
      control.setPosition(eye.x, eye.y, eye.z, false);
      control.setTarget(target.x, target.y, target.z, false);
    }
    this.#door.redraw();
  }

  #direction() {
    const control = this.#control();
    if (!control) return this.#vector(0, 0, 1);
    const eye = control.getPosition(this.#vector());
    return eye.sub(control.getTarget(this.#vector())).normalize();
  }

  /** Points around a link that has nothing to see. @param {string} link @returns {Vector3[]} */
  #around(link) {
    const node = this.#robot.node(link);
    const all = this.#robot.corners();
    const [first] = all;
    if (!node || !first) return [];
    const origin = first.clone().setFromMatrixPosition(node.matrixWorld);
    const reach = Math.max(...all.map((corner) => corner.distanceTo(first))) / 12;
    const aside = first.clone().set(reach, reach, reach);
    return [origin.clone().add(aside), origin.clone().sub(aside)];
  }

  #control() {
    return this.#door.mutable?.cameraControl ?? null;
  }

  /** @returns {Matrix4 | null} */
  #rootMatrix() {
    return this.#door.node("")?.matrixWorld ?? null;
  }

  /** A direction of the root frame in the axes of three.js. @param {[number, number, number]} direction */
  #inScene(direction) {
    const root = this.#rootMatrix();
    const vector = this.#vector(...direction);
    return root ? vector.transformDirection(root) : vector.normalize();
  }

  /** @param {number} [x] @param {number} [y] @param {number} [z] @returns {Vector3} */
  #vector(x = 0, y = 0, z = 0) {
    const camera = this.#door.mutable?.camera;
    if (!camera) throw new Error("The 3D view has no camera yet.");
    return camera.position.clone().set(x, y, z);
  }
}

/** @param {Vector3[]} points */
function middle(points) {
  const [low, high] = [Math.min, Math.max].map((pick) =>
    points.reduce(
      (sum, { x, y, z }) => sum.set(pick(sum.x, x), pick(sum.y, y), pick(sum.z, z)),
      /** @type {Vector3} */ (points[0]).clone(),
    ),
  );
  return /** @type {Vector3} */ (low).add(/** @type {Vector3} */ (high)).multiplyScalar(0.5);
}

/** @param {Vector3} vector @returns {[number, number, number]} */
function toTriple(vector) {
  return [vector.x, vector.y, vector.z];
}

/** Frames that are no links of the robot, which the studio puts there for who asks. */
const ROOT = "/live/followed/";
/** Its name in the scene. @param {string} frame */
export const followedName = (frame) => ROOT + encodeURIComponent(frame);
/** m; a frame that moved less stands still. */
const STILL_M = 1e-6;

/** Lets the camera go with a frame, as RViz's target frame does: with its place, not with its turns. */
export class Follow {
  #door;
  #robot;
  #camera;
  #frame = "";
  /** Where the frame was in the last picture. @type {Vector3 | null} */
  #last = null;
  /** Whether the frame shall be brought to the middle once it is there. */
  #isNew = false;

  /** @param {Door} door @param {RobotView} robot @param {CameraView} camera */
  constructor(door, robot, camera) {
    this.#door = door;
    this.#robot = robot;
    this.#camera = camera;
    door.onPicture(() => this.#go());
  }

  /** @param {string} frame empty: the camera stays where it is */
  set(frame) {
    if (frame === this.#frame) return;
    this.#frame = frame;
    this.#last = null;
    this.#isNew = frame !== "";
    this.#door.redraw();
  }

  #go() {
    const node = this.#frame === "" ? undefined : this.#node();
    const camera = this.#door.mutable?.camera;
    if (!node || !camera) {
      this.#last = null;
      return;
    }
    const now = camera.position.clone().setFromMatrixPosition(node.matrixWorld);
    const moved = now.clone().sub(this.#last ?? now);
    this.#last = now;
    if (this.#isNew) this.#camera.lookAt(now);
    this.#isNew = false;
    if (moved.length() > STILL_M) this.#camera.carry(moved);
  }

  #node() {
    return this.#robot.node(this.#frame) ?? this.#door.node(followedName(this.#frame));
  }
}
