/**
 * How the mouse moves an interactive marker, mode by mode, as RViz does it. All in the reference frame
 * of the marker, with plain arrays: vectors are x, y, z and turns w, x, y, z.
 */

/** @import { Vector } from "../lib/vectors.js" */

import { cross, dot, lengthOf, minus, plus, times } from "../lib/vectors.js";
import { quaternionOf } from "../lib/frame-pose.js";

/** @typedef {[number, number, number, number]} Turn */
/** @typedef {{ turn: Turn, place: Vector }} Pose */
/** @typedef {{ origin: Vector, direction: Vector }} Ray the direction has length 1 */
/** @typedef {{ x: number, y: number, shift: boolean, ctrl: boolean }} Mouse px of the window */
/**
 * @typedef {object} Sight what the drag must know of the picture, in the reference frame as it is now
 * @property {(x: number, y: number) => Ray | null} rayAt
 * @property {(point: Vector) => [number, number] | null} placeOf px of the window; null: behind the eye
 * @property {() => { forward: Vector, up: Vector, right: Vector }} axes of the camera
 */
/** @typedef {{ mode: number, facing: number, wxyz: Turn }} Control */

export const Mode = /** @type {const} */ ({
  NONE: 0,
  MENU: 1,
  BUTTON: 2,
  MOVE_AXIS: 3,
  MOVE_PLANE: 4,
  ROTATE_AXIS: 5,
  MOVE_ROTATE: 6,
  MOVE_3D: 7,
  ROTATE_3D: 8,
  MOVE_ROTATE_3D: 9,
});
export const FIXED = 1;
export const VIEW_FACING = 2;
/** Those that follow the mouse freely, and heed Shift and Ctrl. */
const FREE = new Set([Mode.MOVE_3D, Mode.ROTATE_3D, Mode.MOVE_ROTATE_3D]);
/** Those that a drag moves. */
const DRAGGED = new Set([Mode.MOVE_AXIS, Mode.MOVE_PLANE, Mode.ROTATE_AXIS, Mode.MOVE_ROTATE, ...FREE]);
/** So many pixels are a whole turn. */
const TURN_PX = 300;
const CLICK_PX = 2;
/** Without a better measure. */
const M_PER_PX = 0.001;
const TINY = 1e-6;

/** @param {Turn} a @param {Turn} b @returns {Turn} first b, then a */
export function after([aw, ax, ay, az], [bw, bx, by, bz]) {
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

/** @param {Turn} turn @returns {Turn} */
export const back = ([w, x, y, z]) => [w, -x, -y, -z];

/** @param {Turn} turn @param {Vector} vector @returns {Vector} */
export function turned([w, ...xyz], vector) {
  const twice = times(cross(xyz, vector), 2);
  return plus(plus(vector, times(twice, w)), cross(xyz, twice));
}

/** @param {Vector} axis of length 1 @param {number} rad @returns {Turn} */
export function about(axis, rad) {
  const [x, y, z] = times(axis, Math.sin(rad / 2));
  return [Math.cos(rad / 2), x, y, z];
}

/** @param {Pose} a @param {Pose} b @returns {Pose} */
export const composed = (a, b) => ({
  turn: after(a.turn, b.turn),
  place: plus(a.place, turned(a.turn, b.place)),
});

/** The turn to three axes, each of length 1 and square to the others. @param {Vector} x @param {Vector} y @param {Vector} z @returns {Turn} */
export function turnTo(x, y, z) {
  const rows = [0, 1, 2].flatMap((axis) => [x, y, z, ORIGIN].map((one) => one[/** @type {0} */ (axis)]));
  const [qx, qy, qz, qw] = quaternionOf(rows);
  return [qw, qx, qy, qz];
}

/** @type {Vector} */
const ORIGIN = [0, 0, 0];

/**
 * The turn of a control that faces the eye: its x points away from the eye, its z up.
 * @param {Turn} wxyz of the control @param {{ forward: Vector, up: Vector }} axes of the camera
 * @param {number} rad how far it was turned about its x by hand @returns {Turn}
 */
export function facing(wxyz, { forward, up }, rad) {
  const view = turnTo(forward, cross(up, forward), up);
  return after(about(forward, rad), after(view, back(wxyz)));
}

/** The turn of the axes of a control in the reference frame, before its own orientation.
 * @param {Control} control @param {Turn} turn of the marker @param {number} rad turned by hand @param {Sight} sight @returns {Turn} */
export function frameOf(control, turn, rad, sight) {
  if (control.facing === VIEW_FACING) return facing(control.wxyz, sight.axes(), rad);
  if (control.facing === FIXED) return about(turned(control.wxyz, [1, 0, 0]), rad);
  return turn;
}

/** @param {number} mode whether a drag moves the marker */
export const isDragged = (mode) => DRAGGED.has(/** @type {any} */ (mode));

/** Where a ray meets a plane; null: nowhere ahead of it. @param {Ray | null} ray @param {Vector} normal @param {Vector} point @returns {Vector | null} */
function onPlane(ray, normal, point) {
  const slope = ray ? dot(ray.direction, normal) : 0;
  if (!ray || Math.abs(slope) < TINY) return null;
  const distance = dot(minus(point, ray.origin), normal) / slope;
  return distance >= 0 ? plus(ray.origin, times(ray.direction, distance)) : null;
}

/** The point of a line that is nearest to a ray; null: they are parallel. @param {Vector} point @param {Vector} along @param {Ray} ray @returns {Vector | null} */
function nearestOnLine(point, along, ray) {
  const between = minus(point, ray.origin);
  const [both, size] = [dot(along, ray.direction), dot(along, along)];
  const sine2 = size - both * both;
  if (Math.abs(sine2) < TINY * size) return null;
  const far = (dot(between, ray.direction) * both - dot(between, along)) / sine2;
  return plus(point, times(along, far));
}

/** The angle from one direction to another about an axis of length 1, -pi to pi. @param {Vector} from @param {Vector} to @param {Vector} axis */
const angleAbout = (from, to, axis) => Math.atan2(dot(cross(from, to), axis), dot(from, to));

/** One drag, from the press on. */
export class HandleDrag {
  /** Of the marker in its reference frame. @type {Pose} */
  pose;
  /** How far the control was turned by hand about its axis, rad. */
  rad;
  #control;
  #sight;
  /** Of the control's frame at the press. */
  #frame;
  /** The axis of the control at the press, of length 1. @type {Vector} */
  #axis;
  /** What was gripped. @type {Vector} */
  #grab;
  #start;
  #startRad;
  /** What was gripped, and the place of the axis next to it, in the control's frame. */
  #inControl;
  /** @type {Mouse} */
  #last;
  #mPerPx;

  /** @param {Control} control @param {Sight} sight @param {Pose} pose @param {number} rad
   * @param {Vector | null} grab what the mouse points at @param {Mouse} mouse */
  constructor(control, sight, pose, rad, grab, mouse) {
    this.pose = pose;
    this.rad = rad;
    this.#control = control;
    this.#sight = sight;
    this.#start = pose;
    this.#startRad = rad;
    this.#grab = grab ?? pose.place;
    this.#frame = frameOf(control, pose.turn, rad, sight);
    this.#axis = this.#axisNow();
    const centre = this.#centreOf(pose.place, this.#grab);
    this.#inControl = { grab: this.#toControl(this.#grab), centre: this.#toControl(centre) };
    this.#last = mouse;
    this.#mPerPx = this.#metresPerPixel(mouse);
  }

  /** The axis in the reference frame, through what was gripped. @returns {{ point: Vector, along: Vector }} */
  get line() {
    const isTurn = this.#control.mode !== Mode.MOVE_AXIS;
    const point = isTurn ? this.#centreOf(this.pose.place, this.#grab) : this.#grab;
    return { point, along: this.#axisNow() };
  }

  /** Follow the mouse; whether the pose changed. @param {Mouse} mouse */
  follow(mouse) {
    const before = this.pose;
    const mode = this.#control.mode;
    if (mode === Mode.MOVE_AXIS) this.#moveAxis(mouse);
    else if (mode === Mode.MOVE_PLANE) this.#movePlane(mouse, this.#axisNow());
    else if (mode === Mode.ROTATE_AXIS) this.#rotate(mouse);
    else if (mode === Mode.MOVE_ROTATE) this.#moveRotate(mouse);
    else this.#moveFreely(mouse);
    this.#last = mouse;
    return this.pose !== before;
  }

  /** The wheel, while the button is down: away from the eye, or towards it. @param {number} clicks away is positive */
  wheel(clicks) {
    const { mode } = this.#control;
    if (mode !== Mode.MOVE_3D && mode !== Mode.MOVE_ROTATE_3D) return false;
    this.#moveAway(clicks * CLICK_PX, this.#last);
    return true;
  }

  #axisNow() {
    const frame = frameOf(this.#control, this.pose.turn, this.rad, this.#sight);
    return turned(after(frame, this.#control.wxyz), [1, 0, 0]);
  }

  /** The place of the axis that is nearest to a point. @param {Vector} place @param {Vector} point @returns {Vector} */
  #centreOf(place, point) {
    const axis = this.#axisNow();
    return plus(place, times(axis, dot(minus(point, place), axis)));
  }

  /** @param {Vector} point @returns {Vector} */
  #toControl(point) {
    return turned(back(this.#frame), minus(point, this.#start.place));
  }

  /** @param {Vector} point in the control's frame @returns {Vector} */
  #fromControl(point) {
    const frame = frameOf(this.#control, this.pose.turn, this.rad, this.#sight);
    return plus(this.pose.place, turned(frame, point));
  }

  /** @param {Vector} place */
  #put(place) {
    this.pose = { turn: this.pose.turn, place };
  }

  /** Along the axis as it is seen: the place of it that is nearest to the mouse in the picture. @param {Mouse} mouse */
  #moveAxis({ x, y }) {
    const axis = this.#axisNow();
    const from = this.#sight.placeOf(this.#grab);
    const to = this.#sight.placeOf(plus(this.#grab, times(axis, 10 * this.#mPerPx)));
    if (!from || !to) return;
    const [wayX, wayY] = [to[0] - from[0], to[1] - from[1]];
    const pixels2 = wayX * wayX + wayY * wayY;
    if (pixels2 < TINY) return;
    const share = ((x - from[0]) * wayX + (y - from[1]) * wayY) / pixels2;
    const ray = this.#sight.rayAt(from[0] + share * wayX, from[1] + share * wayY);
    const nearest = ray && nearestOnLine(this.#grab, axis, ray);
    if (nearest) this.#put(plus(minus(nearest, this.#grab), this.#start.place));
  }

  /** @param {Mouse} mouse @param {Vector} normal */
  #movePlane({ x, y }, normal) {
    const met = onPlane(this.#sight.rayAt(x, y), normal, this.#grab);
    if (met) this.#put(plus(minus(met, this.#grab), this.#start.place));
  }

  /** @param {Mouse} mouse */
  #rotate({ x, y }) {
    const axis = this.#axis;
    const { place, turn } = this.#start;
    const centre = plus(place, times(axis, dot(minus(this.#grab, place), axis)));
    const met = onPlane(this.#sight.rayAt(x, y), axis, centre);
    if (!met) return;
    const angle = angleAbout(minus(this.#grab, centre), minus(met, centre), axis);
    this.rad = this.#startRad + angle;
    this.pose = { turn: after(about(axis, angle), turn), place };
  }

  /** Turns it as if what was gripped were drawn along, then moves it there. @param {Mouse} mouse */
  #moveRotate({ x, y }) {
    const [centre, old] = [this.#inControl.centre, this.#inControl.grab].map((one) => this.#fromControl(one));
    const axis = this.#axis;
    const normal = this.#axisNow();
    if (!centre || !old) return;
    const met = onPlane(this.#sight.rayAt(x, y), normal, centre);
    if (!met) return;
    const [from, to] = [minus(old, centre), minus(met, centre)];
    if (lengthOf(to) < TINY || lengthOf(from) < TINY) return;
    const angle = angleAbout(from, to, axis);
    this.rad += angle;
    this.pose = {
      turn: after(about(axis, angle), this.pose.turn),
      place: plus(this.pose.place, times(to, 1 - lengthOf(from) / lengthOf(to))),
    };
  }

  /** @param {Mouse} mouse */
  #moveFreely(mouse) {
    const { mode } = this.#control;
    if (mouse.shift !== this.#last.shift || mouse.ctrl !== this.#last.ctrl) this.#beginAnew(mouse);
    const turns = mode === Mode.ROTATE_3D || (mode === Mode.MOVE_ROTATE_3D && mouse.ctrl);
    const [dx, dy] = [mouse.x - this.#last.x, mouse.y - this.#last.y];
    if (turns && mouse.shift) this.#turnInPicture(Math.abs(dy) > Math.abs(dx) ? dy : dx);
    else if (turns) this.#turnBy(dx, dy);
    else if (mouse.shift) this.#moveAway(Math.abs(dx) > Math.abs(dy) ? dx : -dy, mouse);
    else this.#movePlane(mouse, this.#sight.axes().forward);
  }

  /** From now on what is under the mouse counts as gripped: other keys are held. @param {Mouse} mouse */
  #beginAnew({ x, y }) {
    const through = plus(this.#grab, minus(this.pose.place, this.#start.place));
    this.#grab = onPlane(this.#sight.rayAt(x, y), this.#sight.axes().forward, through) ?? through;
    this.#start = this.pose;
  }

  /** @param {number} dx @param {number} dy px */
  #turnBy(dx, dy) {
    if (dx === 0 && dy === 0) return;
    const { up, right } = this.#sight.axes();
    const turn = after(about(up, radians(dx)), about(right, radians(dy)));
    this.pose = { turn: after(turn, this.pose.turn), place: this.pose.place };
  }

  /** @param {number} pixels */
  #turnInPicture(pixels) {
    if (pixels === 0) return;
    const turn = about(this.#sight.axes().forward, radians(pixels));
    this.pose = { turn: after(turn, this.pose.turn), place: this.pose.place };
  }

  /** @param {number} pixels @param {Mouse} mouse */
  #moveAway(pixels, mouse) {
    const ray = this.#sight.rayAt(mouse.x, mouse.y);
    if (pixels === 0 || !ray) return;
    this.#put(plus(this.pose.place, times(ray.direction, pixels * this.#mPerPx)));
    this.#beginAnew(mouse);
  }

  /** How far a pixel is in the plane of the picture through what was gripped. @param {Mouse} mouse */
  #metresPerPixel({ x, y }) {
    const { forward } = this.#sight.axes();
    const [here, there] = [0, 10].map((down) =>
      onPlane(this.#sight.rayAt(x, y + down), forward, this.#grab),
    );
    const metres = here && there ? lengthOf(minus(there, here)) / 10 : 0;
    return metres > TINY * TINY ? metres : M_PER_PX;
  }
}

/** @param {number} pixels */
const radians = (pixels) => (2 * Math.PI * pixels) / TURN_PX;
