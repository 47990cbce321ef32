/** @import { Door } from "./door.js" */
/** @import { LiveExtent } from "./extent.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { Frame, Kind, Pose, Triple, Turn, Value, Values, View } from "../lib/view-poses.js" */
/** @import { Way } from "../lib/view-moves.js" */
/** @import { CameraControl, CameraPose, Vector3 } from "./viser.d.ts" */

import { fromFixedFrame, inFixedFrame } from "./ground.js";
import { Orthographic } from "./orthographic.js";
import { fitting } from "../lib/view-fit.js";
import { dragged, lookedAt, pinched, RAD_PER_PX, wheeled, zeroed } from "../lib/view-moves.js";
import {
  eyeOf,
  fieldOf,
  followed,
  into,
  isFlat,
  isKind,
  lookTurn,
  NO_TURN,
  numberOf,
  ORTHOGRAPHIC,
  orbits,
  outOf,
  placeIn,
  poseBetween,
  poseOf,
  TARGET_FRAME,
  targetOf,
  towards,
  turned,
  turnFrom,
  viewOf,
  withValues,
} from "../lib/view-poses.js";
import { lengthOf, minus } from "../lib/vectors.js";

const FILL = 2 / 3;
const FOCUS_FILL = 0.45;
/** Around what may be as small as a point. */
const ROOM_M = 0.1;
const FLIGHT_MS = 300;
/** viser's, and more of them where we look from afar. */
const FAR_M = 1000;
const FAR_SHARE = 20;
/** After so long, and so many pictures, without another mesh the robot is there, and what an edit
 * adds moves no camera. */
const ARRIVED = { ms: 5000, pictures: 10 };

/** From what is looked at towards the eye, in the fixed frame. @type {Record<string, Triple>} */
const DIRECTIONS = {
  front: [1, 0, 0],
  back: [-1, 0, 0],
  left: [0, 1, 0],
  right: [0, -1, 0],
  top: [0, 0, 1],
  bottom: [0, 0, -1],
  iso: [1, -0.8, 0.62],
};

/** Another's camera, which is shown until a hand takes over. @typedef {{pose: Pose, flat: boolean, field: number}} Guest */

/**
 * This browser's own camera: one of RViz's views, whose values say where it is, and which may go with a
 * frame. It is left alone by all that the server does. Places are in the fixed frame, z up.
 */
export class CameraView {
  #door;
  #robot;
  #live;
  #tell;
  #orthographic;
  /** @type {View} */
  #view = { kind: "Orbit", values: {} };
  /** @type {Guest | null} */
  #guest = null;
  /** @type {{from: Pose, began_ms: number} | null} */
  #flight = null;
  /** What the last picture showed. @type {Pose | null} */
  #shown = null;
  /** Where the frame is, or was last, that the view goes with. @type {Frame} */
  #frame = { place: [0, 0, 0], turn: NO_TURN };
  /** What is to be done once a frame that was chosen is there. @type {"stay" | "look" | null} */
  #once = null;
  #untouched = true;
  /** A hand was on it since the last picture. */
  #byHand = false;
  /** Width by height of the picture. */
  #aspect = 0;
  /** The most meshes that stood in the scene at once. */
  #meshes = 0;
  #lastArrival_ms = 0;
  #picturesSince = 0;
  /** @type {CameraControl | null} viser may make another */
  #control = null;
  /** What was told of last. @type {View | Guest | null} */
  #told = null;

  /** @param {Door} door @param {RobotView} robot @param {LiveExtent} live
   * @param {(type: string, detail: object) => void} tell */
  constructor(door, robot, live, tell) {
    this.#door = door;
    this.#robot = robot;
    this.#live = live;
    this.#tell = tell;
    this.#orthographic = new Orthographic(door);
    door.onPicture(() => {
      this.#takeControl();
      this.#keepInPicture();
      this.#fitWhileMeshesArrive();
      this.#place();
      this.#door.mutable?.camera?.updateWorldMatrix(false, false);
      this.#tellView();
      this.#byHand = false;
    });
  }

  /** A hand on the camera ends the fitting by itself, and what another shows. */
  touched() {
    this.#untouched = false;
    this.#byHand = true;
    this.#door.redraw();
    this.#adopt();
  }

  /** The view that is shown, with all that a hand did. @returns {View} */
  get current() {
    return this.#guest ? this.#asView(this.#guest) : this.#view;
  }

  /** @param {{kind: string, values: Values}} view @param {boolean} [animate] */
  use({ kind, values }, animate = true) {
    if (!isKind(kind)) throw new RangeError(`There is no view "${kind}".`);
    this.#untouched = this.#byHand = false;
    this.#once = null;
    this.#change({ kind, values }, animate);
  }

  /** Another kind of view, which shows the same as far as it can. @param {string} kind */
  setKind(kind) {
    if (!isKind(kind)) throw new RangeError(`There is no view "${kind}".`);
    this.touched();
    if (kind === this.#view.kind) return;
    const frame = followed({ ...this.#view, kind }, this.#frame);
    this.#change(viewOf(kind, into(frame, this.#goal()), this.#view, this.#size()), true);
  }

  /** @param {string} name RViz's @param {Value} value */
  setValue(name, value) {
    this.touched();
    if (name === TARGET_FRAME) this.#setTarget(String(value), "stay");
    else if (name === ORTHOGRAPHIC) this.#setFlat(value === true);
    else if (name === "Point towards") this.#change(towards(this.#view, String(value)), true);
    else this.#change(withValues(this.#view, { [name]: value }), false);
  }

  /** Go with a frame, with it in the middle. @param {string} frame empty: with none */
  follow(frame) {
    if (frame === targetOf(this.#view)) return;
    this.touched();
    this.#setTarget(frame, frame === "" ? "stay" : "look");
  }

  /** RViz's Zero. */
  zero() {
    this.touched();
    this.#change(zeroed(this.#view), true);
  }

  /** Show all that is drawn from where we look. @param {boolean} [animate] */
  fit(animate = true) {
    this.#adopt();
    const corners = [...this.#robot.corners(), ...this.#live.corners()];
    this.#look(corners, this.#goal().turn, FILL, animate);
  }

  /** Show the whole robot from one side. @param {string} name @param {boolean} [animate] */
  view(name, animate = true) {
    const direction = DIRECTIONS[name];
    if (!direction) throw new RangeError(`There is no view "${name}".`);
    this.touched();
    this.#look(this.#robot.corners(), turnFrom(direction), FILL, animate);
  }

  /** Show the same point from another side. @param {Triple} direction from it to the eye */
  seeFrom(direction) {
    this.touched();
    this.#show({ ...this.#goal(), turn: turnFrom(direction) }, true);
  }

  /** Bring one link to the middle. @param {string} link */
  focus(link) {
    const corners = this.#robot.corners([link]);
    this.touched();
    this.#look(corners.length ? corners : this.#around(link), this.#goal().turn, FOCUS_FILL, true);
  }

  /** Bring points of the scene to the middle, with some room around them. @param {Vector3[]} points */
  focusOn(points) {
    const [first] = points;
    if (!first) return;
    this.touched();
    const aside = first.clone().set(ROOM_M, ROOM_M, ROOM_M);
    const around = points.flatMap((one) => [one.clone().add(aside), one.clone().sub(aside)]);
    this.#look(around, this.#goal().turn, FOCUS_FILL, true);
  }

  /** Turn to a place of the scene, as RViz does: the eye stays. @param {Vector3} place */
  lookAt(place) {
    const at = inFixedFrame(this.#door, place);
    if (!at) return;
    this.touched();
    this.#change(lookedAt(this.#view, placeIn(this.#followed(), at), this.#size()), true);
  }

  /** @param {Way} way @param {number} dx px @param {number} dy px @param {readonly [number, number]} [at] px */
  drag(way, dx, dy, at) {
    this.touched();
    this.#change(dragged(this.#view, way, dx, dy, this.#size(), at), false);
  }

  /** @param {number} diff RViz's: 120 for a notch away from the hand @param {boolean} shift */
  wheel(diff, shift) {
    this.touched();
    this.#change(wheeled(this.#view, diff, shift), false);
  }

  /** @param {number} ratio by which two fingers spread */
  pinch(ratio) {
    this.touched();
    this.#change(pinched(this.#view, ratio), false);
  }

  /** What an orbit turns about; null: the view has no such point.
   * @returns {{place: Triple, size: number, isGround: boolean, slope: number} | null} */
  get focal() {
    const view = this.#view;
    if (!orbits(view.kind) || this.#guest) return null;
    const [x, y, z] = ["X", "Y", "Z"].map((axis) => numberOf(view, `Focal Point/${axis}`));
    const pose = { focal: /** @type {Triple} */ ([x, y, z]), distance: 0, turn: NO_TURN };
    const distance = numberOf(view, "Distance");
    const share = (view.values["Focal Shape Fixed Size"] ?? true) ? 1 : distance;
    const { focal: place } = outOf(this.#followed(), pose);
    const size = numberOf(view, "Focal Shape Size") * share;
    const slope = numberOf(view, "Pitch");
    return { place, size, isGround: view.kind === "XYOrbit", slope };
  }

  /** @returns {CameraPose | null} */
  get() {
    if (!this.#control) return null;
    const { pose, flat, field } = this.#guest ?? this.#asGuest();
    const up = turned(pose.turn, [0, 1, 0]);
    return { position: eyeOf(pose), target: pose.focal, up, flat, field };
  }

  /** Show another's camera. @param {CameraPose} pose @param {boolean} [animate] */
  set({ position, target, up = [0, 0, 1], flat, field }, animate = false) {
    const back = minus(position, target);
    if (!(lengthOf(back) > 0)) return;
    const before = this.#guest ?? this.#asGuest();
    this.#untouched = false;
    if (animate) this.#takeOff();
    const pose = { focal: target, distance: lengthOf(back), turn: lookTurn(back, up) };
    this.#guest = { pose, flat: flat ?? before.flat, field: field ?? before.field };
    this.#door.redraw();
  }

  /** How it is turned, or is about to be. @returns {Turn} */
  get turn() {
    return this.#goal().turn;
  }

  /** Distance from the eye to what it looks at, m. */
  distance() {
    return this.#goal().distance;
  }

  /** Where the camera is, or is about to be. @returns {Pose} */
  #goal() {
    if (this.#guest) return this.#guest.pose;
    return outOf(this.#followed(), poseOf(this.#view, this.#size()));
  }

  #followed() {
    return followed(this.#view, this.#frame);
  }

  /** @returns {Guest} */
  #asGuest() {
    return { pose: this.#goal(), flat: isFlat(this.#view), field: fieldOf(this.#view) };
  }

  /** What another shows as a view of our own. A map that is to be something else becomes an Orbit.
   * @param {Guest} guest @returns {View} */
  #asView({ pose, flat, field }) {
    const isMap = flat && turned(pose.turn, [0, 0, 1])[2] > 0.9999;
    const kind = this.#view.kind === "TopDownOrtho" && !isMap ? "Orbit" : this.#view.kind;
    const before = withValues(this.#view, { [ORTHOGRAPHIC]: flat, "Field of View": field });
    return viewOf(kind, into(followed({ ...before, kind }, this.#frame), pose), before, this.#size());
  }

  #adopt() {
    if (!this.#guest) return;
    this.#view = this.#asView(this.#guest);
    this.#guest = null;
  }

  /** @param {View} view @param {boolean} animate */
  #change(view, animate) {
    if (animate) this.#takeOff();
    this.#guest = null;
    this.#view = view;
    this.#door.redraw();
  }

  #takeOff() {
    const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.#flight = this.#shown && !isCalm ? { from: this.#shown, began_ms: performance.now() } : null;
  }

  /** See what a camera sees, by a view of this kind. @param {Pose} pose @param {boolean} animate @param {Kind} [kind] */
  #show(pose, animate, kind = this.#kindFor(pose)) {
    // What was seen without perspective is seen from the side so, too.
    const isLeft = this.#view.kind === "TopDownOrtho" && kind !== "TopDownOrtho";
    const before = isLeft ? withValues(this.#view, { [ORTHOGRAPHIC]: true }) : this.#view;
    const frame = followed({ ...before, kind }, this.#frame);
    this.#change(viewOf(kind, into(frame, pose), before, this.#size()), animate);
  }

  /** A map looks down and nowhere else. @param {Pose} pose @returns {Kind} */
  #kindFor({ turn }) {
    const { kind } = this.#view;
    return kind === "TopDownOrtho" && turned(turn, [0, 0, 1])[2] < 0.999 ? "Orbit" : kind;
  }

  /** What is looked at keeps its size. @param {boolean} flat */
  #setFlat(flat) {
    if (this.#view.kind === "TopDownOrtho") return;
    const pose = poseOf(this.#view, this.#size());
    const before = withValues(this.#view, { [ORTHOGRAPHIC]: flat });
    const kept = withValues(before, viewOf(before.kind, pose, before, this.#size()).values);
    this.#change({ ...kept, reach: pose.distance }, false);
  }

  /** @param {string} frame @param {"stay" | "look"} once */
  #setTarget(frame, once) {
    this.#view = withValues(this.#view, { [TARGET_FRAME]: frame || "<Fixed Frame>" });
    this.#once = once;
    this.#door.redraw();
  }

  /** Take over from viser: it calls us before each picture, and when an arrow key is held. */
  #takeControl() {
    const control = this.#door.mutable?.cameraControl ?? null;
    if (!control || control === this.#control) return;
    this.#control = control;
    Object.assign(control.mouseButtons, { left: 0, middle: 0, right: 0, wheel: 0 });
    Object.assign(control.touches, { one: 0, two: 0, three: 0 });
    control.update = () => {
      this.#place();
      return false;
    };
    control.rotate = (azimuth, polar) => this.#turnByKey(azimuth, polar);
    const inScene = (/** @type {Triple} */ place) => fromFixedFrame(this.#door, place);
    control.getPosition = (target) => target.copy(inScene(eyeOf(this.#goal())) ?? target);
    control.getTarget = (target) => target.copy(inScene(this.#goal().focal) ?? target);
  }

  /** @param {number} azimuth rad to the right @param {number} polar rad downwards */
  #turnByKey(azimuth, polar) {
    const side = (orbits(this.#view.kind) ? -1 : 1) / RAD_PER_PX;
    this.#tell("touch", {});
    this.drag("turn", side * azimuth, side * polar);
  }

  /** Put viser's camera where the view says. */
  #place() {
    const { camera } = this.#door.mutable ?? {};
    const root = this.#door.node("");
    if (!camera || !root || !this.#control) return;
    this.#goWithFrame();
    const pose = this.#inFlight(this.#goal());
    const [x, y, z, w] = pose.turn;
    const turn = root.getWorldQuaternion(camera.quaternion.clone());
    camera.quaternion.copy(turn.multiply(camera.quaternion.clone().set(x, y, z, w)));
    camera.position.copy(this.#vector(...eyeOf(pose)).applyMatrix4(root.matrixWorld));
    this.#project(pose);
    if (this.#shown?.turn.join() !== pose.turn.join()) this.#tell("turned", { turn: pose.turn });
    this.#shown = pose;
  }

  /** @param {Pose} pose */
  #project(pose) {
    const { camera } = this.#door.mutable ?? {};
    if (!camera) return;
    const { flat, field } = this.#guest ?? { flat: isFlat(this.#view), field: fieldOf(this.#view) };
    const fov = (field * 180) / Math.PI;
    const near = Math.max(numberOf(this.#view, "Near Clip Distance"), 0.001);
    const far = Math.max(FAR_M, FAR_SHARE * pose.distance, 2 * near);
    if (camera.fov !== fov || camera.near !== near || camera.far !== far) {
      Object.assign(camera, { fov, near, far });
      camera.updateProjectionMatrix();
    }
    this.#orthographic.set(flat ? pose.distance : null);
  }

  /** @param {Pose} goal @returns {Pose} */
  #inFlight(goal) {
    if (!this.#flight) return goal;
    const part = (performance.now() - this.#flight.began_ms) / FLIGHT_MS;
    if (part >= 1) {
      this.#flight = null;
      return goal;
    }
    this.#door.redraw();
    return poseBetween(this.#flight.from, goal, part * part * (3 - 2 * part));
  }

  /** The frame as it is in this very picture; one that is not there stays where it was. */
  #goWithFrame() {
    const name = targetOf(this.#view);
    const now = name === "" ? { place: /** @type {Triple} */ ([0, 0, 0]), turn: NO_TURN } : this.#placeOf(name);
    if (!now) return;
    const [once, before] = [this.#once, this.#goal()];
    this.#once = null;
    this.#frame = now;
    if (!once || this.#guest) return;
    const pose = once === "look" ? { ...before, focal: now.place } : before;
    // RViz jumps with one that is aligned to its frame: it shall look along an axis of the new one.
    if (this.#view.kind === "FrameAligned" && once === "stay") return this.#change(this.#view, true);
    if (once === "look") this.#takeOff();
    return this.#show(pose, once === "look", this.#view.kind);
  }

  /** @param {string} name @returns {Frame | null} */
  #placeOf(name) {
    const node = this.#robot.node(name) ?? this.#door.node(followedName(name));
    const [camera, root] = [this.#door.mutable?.camera, this.#door.node("")];
    if (!node || !camera || !root) return null;
    const back = root.matrixWorld.clone().invert();
    const place = this.#vector().setFromMatrixPosition(node.matrixWorld).applyMatrix4(back);
    const turn = root.getWorldQuaternion(camera.quaternion.clone()).invert();
    turn.multiply(node.getWorldQuaternion(camera.quaternion.clone()));
    return { place: toTriple(place), turn: [turn.x, turn.y, turn.z, turn.w] };
  }

  #tellView() {
    const shown = this.#guest ?? this.#view;
    if (this.#told === shown) return;
    this.#told = shown;
    const { kind, values } = this.current;
    this.#tell("view", { kind, values, byHand: this.#byHand });
  }

  #size() {
    const { canvas } = this.#door.mutable ?? {};
    return {
      width: canvas?.clientWidth || innerWidth || 1,
      height: canvas?.clientHeight || innerHeight || 1,
    };
  }

  /** A picture of another shape shows at least as much: what was seen along its shorter side stays seen. */
  #keepInPicture() {
    const { innerWidth: width, innerHeight: height } = window;
    if (!this.#control || !width || !height) return;
    const before = this.#aspect;
    this.#aspect = width / height;
    if (!before || before === this.#aspect) return;
    if (this.#isArriving()) {
      this.#fitArrived(this.#goal().turn);
      return;
    }
    const farther = Math.min(1, before) / Math.min(1, this.#aspect);
    if (farther === 1 || !orbits(this.#view.kind) || this.#guest) return;
    const Distance = numberOf(this.#view, "Distance") * farther;
    this.#change(withValues(this.#view, { Distance }), false);
  }

  /** An edit that makes a mesh anew, or a hand that hides one, leaves the camera alone. */
  #fitWhileMeshesArrive() {
    if (!this.#control || !this.#isArriving()) return this.#noteDrawn();
    this.#picturesSince += 1;
    const meshes = this.#robot.meshCount();
    if (meshes <= this.#meshes) return undefined;
    const first = this.#meshes === 0;
    this.#meshes = meshes;
    this.#lastArrival_ms = performance.now();
    this.#picturesSince = 0;
    this.#fitArrived(first ? turnFrom(DIRECTIONS.iso ?? [1, 0, 0]) : this.#goal().turn);
    return this.#noteDrawn();
  }

  /** That the robot is drawn, for who waits for it. */
  #noteDrawn() {
    const { dataset } = document.documentElement;
    if (!("drawn" in dataset) && this.#control && this.#robot.meshCount() > 0) dataset.drawn = "";
  }

  #isArriving() {
    if (!this.#untouched || this.#meshes === 0) return this.#untouched;
    const rest_ms = performance.now() - this.#lastArrival_ms;
    return rest_ms < ARRIVED.ms || this.#picturesSince < ARRIVED.pictures;
  }

  /** @param {Turn} turn */
  #fitArrived(turn) {
    this.#look(this.#robot.corners(this.#robot.drawn), turn, FILL, false);
  }

  /** Look at points so that they fill a part of the picture and lie in its middle.
   * @param {Vector3[]} corners @param {Turn} turn @param {number} fill @param {boolean} animate */
  #look(corners, turn, fill, animate) {
    const root = this.#door.node("")?.matrixWorld;
    if (corners.length === 0 || !root) return;
    const back = root.clone().invert();
    const points = corners.map((corner) => toTriple(corner.clone().applyMatrix4(back)));
    const { width, height } = this.#size();
    const [flat, field] = [isFlat(this.#view), fieldOf(this.#view)];
    const picture = { field, aspect: width / height, fill, flat };
    this.#show(fitting(points, turn, picture), animate);
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

  /** @param {number} [x] @param {number} [y] @param {number} [z] @returns {Vector3} */
  #vector(x = 0, y = 0, z = 0) {
    const camera = this.#door.mutable?.camera;
    if (!camera) throw new Error("The 3D view has no camera yet.");
    return camera.position.clone().set(x, y, z);
  }
}

/** @param {Vector3} vector @returns {[number, number, number]} */
function toTriple(vector) {
  return [vector.x, vector.y, vector.z];
}

/** Frames that are no links of the robot, which the studio puts there for who asks. */
const ROOT = "/live/followed/";
/** Its name in the scene. @param {string} frame */
export const followedName = (frame) => ROOT + encodeURIComponent(frame);
