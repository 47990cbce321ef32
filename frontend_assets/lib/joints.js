/** Joints as sliders: which move, between which ends, in which unit. */

/** @import { JointView } from "../types/wire.d.ts" */

import { niceStep, toDegrees, toRadians } from "./numbers.js";

const STILL = new Set(["fixed", "planar", "floating"]);

/** @param {readonly JointView[]} joints @returns {JointView[]} in the order of the joint frames */
export function movableJoints(joints) {
  return joints.filter((joint) => !STILL.has(joint.type));
}

/** @param {JointView} joint @returns {boolean} its position is an angle */
export function isAngle(joint) {
  return joint.type !== "prismatic";
}

/**
 * @param {JointView} joint
 * @returns {{lower: number, upper: number, limited: boolean}} rad or m; a turn or +-1 m without limits
 */
export function rangeOf(joint) {
  const { lower, upper } = joint;
  if (joint.type !== "continuous" && lower !== null && upper !== null && lower < upper) {
    return { lower, upper, limited: true };
  }
  const span = isAngle(joint) ? Math.PI : 1;
  return { lower: -span, upper: span, limited: false };
}

/**
 * How a joint's position is shown and taken; one that turns without end is shown within one turn.
 *
 * @param {JointView} joint
 * @param {boolean} degrees
 * @returns {{unit: string, show: (value: number) => number, take: (shown: number) => number, step: number}}
 */
export function unitsOf(joint, degrees) {
  const { lower, upper } = rangeOf(joint);
  const same = (/** @type {number} */ value) => value;
  const seen = joint.type === "continuous" ? wrapped : same;
  if (isAngle(joint) && degrees)
    return { unit: "°", show: (rad) => toDegrees(seen(rad)), take: toRadians, step: 1 };
  const unit = isAngle(joint) ? "rad" : "m";
  return { unit, show: seen, take: same, step: niceStep(lower, upper) };
}

/** @param {number} rad @returns {number} the same direction, from -pi to pi; what is there already stays as it is */
function wrapped(rad) {
  if (Math.abs(rad) <= Math.PI || !Number.isFinite(rad)) return rad;
  return rad - 2 * Math.PI * Math.round(rad / (2 * Math.PI));
}
