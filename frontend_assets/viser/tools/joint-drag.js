/** A joint that follows the mouse. */

/** @import { Door } from "../door.js" */
/** @import { RobotView } from "../robot.js" */
/** @import { JointView, Vector3 } from "../viser.d.ts" */

import { rayThrough } from "../picking.js";

/** A plane or line seen at less than this sine is grazed: then the mouse's way on screen counts. */
const GRAZING = 0.2;

/**
 * One joint that follows the mouse. Turning: the angle of the mouse about the axis, in the plane
 * through the place that was gripped; sliding: the point of the axis that is nearest to the mouse.
 * Seen edge-on, the mouse's way along the motion on screen.
 */
export class JointDrag {
  /** Of the joint that is set: the gripped one, or the one that it follows. */
  value;
  start;
  #door;
  #gripped;
  #ratio;
  #measure;
  #moved = 0;
  #last;

  /** @param {Door} door @param {RobotView} robot @param {JointView} joint @param {Vector3} grip
   * @param {number} x @param {number} y */
  constructor(door, robot, joint, grip, x, y) {
    const { leader, ratio } = robot.leaderOf(joint);
    this.#door = door;
    this.#gripped = joint;
    this.leader = leader;
    this.#ratio = ratio;
    this.start = robot.positions.get(leader.name) ?? 0;
    this.value = this.start;
    const node = robot.node(joint.child);
    if (!node) throw new Error(`The link "${joint.child}" is not drawn.`);
    const origin = grip.clone().setFromMatrixPosition(node.matrixWorld);
    const axis = grip
      .clone()
      .set(...joint.axis)
      .transformDirection(node.matrixWorld);
    this.#measure = this.#chooseMeasure(origin, axis, grip, x, y);
    this.#last = this.#measure(x, y) ?? 0;
  }

  /** Follow the mouse; whether the value changed. @param {number} x @param {number} y */
  follow(x, y) {
    const now = this.#measure(x, y);
    if (now === null) return false;
    let step = now - this.#last;
    if (this.#gripped.type !== "prismatic") step -= 2 * Math.PI * Math.round(step / (2 * Math.PI));
    this.#last = now;
    this.#moved += step;
    const value = this.#clamped(this.start + this.#moved / this.#ratio);
    const changed = value !== this.value;
    this.value = value;
    return changed;
  }

  /** @param {number} value */
  #clamped(value) {
    const { type, lower, upper } = this.leader;
    if (type === "continuous" || lower === null || upper === null || lower > upper) return value;
    return Math.min(Math.max(value, lower), upper);
  }

  /** How far the joint is at a place of the mouse, rad or m, from some zero; null: cannot be said.
   * @param {Vector3} origin @param {Vector3} axis @param {Vector3} grip @param {number} x @param {number} y
   * @returns {(x: number, y: number) => number | null} */
  #chooseMeasure(origin, axis, grip, x, y) {
    const ray = rayThrough(this.#door, x, y);
    const along = ray ? Math.abs(ray.direction.dot(axis)) : 1;
    if (this.#gripped.type === "prismatic") {
      if (1 - along * along < GRAZING * GRAZING) return this.#screenMeasure(grip, axis, x, y);
      return (mouseX, mouseY) => this.#slide(origin, axis, mouseX, mouseY);
    }
    const centre = origin.clone().addScaledVector(axis, grip.clone().sub(origin).dot(axis));
    const arm = grip.clone().sub(centre);
    if (along < GRAZING || arm.length() < 1e-4) {
      return this.#screenMeasure(grip, axis.clone().cross(arm), x, y);
    }
    const ahead = arm.clone().normalize();
    const aside = axis.clone().cross(ahead);
    return (mouseX, mouseY) => this.#angle(centre, axis, ahead, aside, mouseX, mouseY);
  }

  /** @param {Vector3} origin @param {Vector3} axis @param {number} x @param {number} y */
  #slide(origin, axis, x, y) {
    const ray = rayThrough(this.#door, x, y);
    if (!ray) return null;
    const between = origin.clone().sub(ray.origin);
    const cosine = axis.dot(ray.direction);
    const sine2 = 1 - cosine * cosine;
    if (sine2 < 1e-4) return null;
    return (cosine * between.dot(ray.direction) - between.dot(axis)) / sine2;
  }

  /** @param {Vector3} centre @param {Vector3} axis @param {Vector3} ahead @param {Vector3} aside
   * @param {number} x @param {number} y */
  #angle(centre, axis, ahead, aside, x, y) {
    const ray = rayThrough(this.#door, x, y);
    if (!ray) return null;
    const facing = ray.direction.dot(axis);
    if (Math.abs(facing) < GRAZING / 4) return null;
    const distance = centre.clone().sub(ray.origin).dot(axis) / facing;
    if (distance <= 0) return null;
    const arm = ray.origin.clone().addScaledVector(ray.direction, distance).sub(centre);
    return Math.atan2(arm.dot(aside), arm.dot(ahead));
  }

  /** Pixels along the motion on screen, in rad or m. @param {Vector3} grip
   * @param {Vector3} motion What the grip does for one unit of the joint. @param {number} x0 @param {number} y0
   * @returns {(x: number, y: number) => number} */
  #screenMeasure(grip, motion, x0, y0) {
    const step = 0.01;
    const from = this.#onScreen(grip);
    const to = this.#onScreen(grip.clone().addScaledVector(motion, step));
    const [wayX, wayY] = [(to[0] - from[0]) / step, (to[1] - from[1]) / step];
    const pixels2 = wayX * wayX + wayY * wayY;
    // Seen end-on there is no way on screen: then up is more, a turn for 400 pixels.
    if (pixels2 < 400) return (_, y) => (y0 - y) / 400;
    return (x, y) => ((x - x0) * wayX + (y - y0) * wayY) / pixels2;
  }

  /** @param {Vector3} point @returns {[number, number]} */
  #onScreen(point) {
    const { canvas, camera } = this.#door.mutable ?? {};
    if (!canvas || !camera) return [0, 0];
    const seen = point.clone().project(camera);
    return [(seen.x * canvas.clientWidth) / 2, (-seen.y * canvas.clientHeight) / 2];
  }
}
