/** A pose as people write it: roll, pitch, yaw, a quaternion, a matrix, and each of them as text. */

/** @import { JointView } from "../types/wire.d.ts" */
/** @import { Pose } from "./kinematics.js" */

import { translationOf } from "./kinematics.js";
import { formatNumber } from "./numbers.js";

/** Cosine of the pitch below which roll and yaw cannot be told apart. */
const LOCKED = 1e-9;
/** And below which other roll and yaw give almost the same pose. */
const NEARLY_LOCKED = 1e-4;
const DIGITS = 12;
/** Noise of the arithmetic, in m or parts of a rotation. */
const NOISE = 1e-14;

/**
 * @typedef {object} Turn
 * @property {readonly [number, number, number]} rpy rad about the fixed axes x, then y, then z, as in URDF
 * @property {boolean} locked pitch is at +-90 degrees: roll and yaw turn about the same axis
 */

/** @param {Pose} pose @param {number} at @returns {number} */
const n = (pose, at) => /** @type {number} */ (pose[at]);

/** @param {Pose} pose @returns {Turn} of all that give this pose the one with the least roll when locked */
export function turnOf(pose) {
  const level = Math.hypot(n(pose, 0), n(pose, 4));
  const pitch = Math.atan2(-n(pose, 8), level);
  const locked = level < NEARLY_LOCKED;
  if (level < LOCKED) return { rpy: [0, pitch, Math.atan2(-n(pose, 1), n(pose, 5))], locked };
  const roll = Math.atan2(n(pose, 9), n(pose, 10));
  return { rpy: [roll, pitch, Math.atan2(n(pose, 4), n(pose, 0))], locked };
}

/** @param {Pose} pose @returns {[number, number, number, number]} x, y, z, w of length 1, w not negative */
export function quaternionOf(pose) {
  const [xx, yy, zz] = [n(pose, 0), n(pose, 5), n(pose, 10)];
  // Four times the square of each; the largest is divided by.
  const squares = [1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz];
  const [x, y, z] = [n(pose, 9) - n(pose, 6), n(pose, 2) - n(pose, 8), n(pose, 4) - n(pose, 1)];
  const [xy, xz, yz] = [n(pose, 1) + n(pose, 4), n(pose, 2) + n(pose, 8), n(pose, 6) + n(pose, 9)];
  const largest = squares.indexOf(Math.max(...squares));
  const found = [
    [n(squares, 0), xy, xz, x],
    [xy, n(squares, 1), yz, y],
    [xz, yz, n(squares, 2), z],
    [x, y, z, n(squares, 3)],
  ][largest] ?? [0, 0, 0, 1];
  const length = Math.hypot(...found) * (n(found, 3) < 0 ? -1 : 1);
  return /** @type {[number, number, number, number]} */ (found.map((one) => one / length));
}

/**
 * @param {readonly [number, number, number, number]} wxyz a quaternion of length 1
 * @param {readonly [number, number, number]} xyz m
 * @returns {Pose}
 */
export function poseOfQuaternion([w, x, y, z], [tx, ty, tz]) {
  return [
    ...[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), tx],
    ...[2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), ty],
    ...[2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), tz],
  ];
}

/** @param {Pose} pose @returns {number[][]} four rows */
export function matrixOf(pose) {
  return [pose.slice(0, 4), pose.slice(4, 8), pose.slice(8, 12), [0, 0, 0, 1]];
}

/** @param {number} value @returns {string} to 12 digits, for a file or a program */
export const written = (value) => formatNumber(Math.abs(value) < NOISE ? 0 : value, DIGITS);

/** @param {readonly number[]} values @returns {string} with blanks between */
export const asText = (values) => values.map(written).join(" ");

/** @param {readonly number[]} values @returns {string} a list of Python's */
export const asList = (values) => `[${values.map(written).join(", ")}]`;

/** @param {Pose} pose @returns {string} */
export const matrixText = (pose) => matrixOf(pose).map(asText).join("\n");

/** @param {Pose} pose @returns {string} a list of rows */
export const matrixList = (pose) => `[${matrixOf(pose).map(asList).join(", ")}]`;

/** @param {Pose} pose @returns {string} the element of a joint or a visual that has this pose */
export function asOrigin(pose) {
  return `<origin xyz="${asText(translationOf(pose))}" rpy="${asText(turnOf(pose).rpy)}"/>`;
}

/** A joint on the way, and whether it is passed from its child to its parent. @typedef {{joint: JointView, up: boolean}} Step */

/**
 * The way through the tree from one link to another.
 *
 * @param {readonly JointView[]} joints
 * @param {string} from
 * @param {string} to
 * @returns {Step[] | null} null: they hang on different roots
 */
export function wayBetween(joints, from, to) {
  const above = new Map(joints.map((joint) => [joint.child, joint]));
  const [up, down] = [wayToRoot(above, from), wayToRoot(above, to)];
  if ((up.at(-1)?.parent ?? from) !== (down.at(-1)?.parent ?? to)) return null;
  while (up.length > 0 && up.at(-1) === down.at(-1)) {
    up.pop();
    down.pop();
  }
  return [
    ...up.map((joint) => ({ joint, up: true })),
    ...down.reverse().map((joint) => ({ joint, up: false })),
  ];
}

/** @param {ReadonlyMap<string, JointView>} above by child @param {string} link @returns {JointView[]} nearest first */
function wayToRoot(above, link) {
  const way = [];
  const seen = new Set();
  for (let joint = above.get(link); joint && !seen.has(joint); joint = above.get(joint.parent)) {
    seen.add(joint);
    way.push(joint);
  }
  return way;
}
