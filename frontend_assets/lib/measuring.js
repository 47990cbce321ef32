/** Distances and angles between points, link frames and joint axes of a robot as it stands. */

/** @import { JointView } from "../types/wire.d.ts" */
/** @import { Pose, Triple } from "./kinematics.js" */

import { AT_REST, moved, translationOf, turned, turnedBack } from "./kinematics.js";
import { shownMeasure, toDegrees } from "./numbers.js";

/**
 * Something that is measured, kept in the frame of its link so that it moves along: a point of a
 * surface with its normal, the frame of a link, or the axis of a joint, which is at rest in its child.
 *
 * @typedef {{kind: "point", link: string, at: Triple, normal: Triple | null} | {kind: "frame", link: string} | {kind: "axis", link: string, joint: string}} Anchor
 */
/** Where an anchor is in the root frame; the direction is its normal, z axis or axis. @typedef {{anchor: Anchor, at: Triple, direction: Triple | null}} Placed */
/**
 * @typedef {object} Measured all lengths in m, all angles in rad
 * @property {readonly Placed[]} ends
 * @property {number} distance between the first two
 * @property {Triple} inRoot from the first to the second, in the root frame
 * @property {Triple} inFirst the same in the frame of the first one's link
 * @property {number | null} toAxis the shortest way between the lines, or from the line to the point; null: there is no line
 * @property {number | null} angle between the directions of the first two; null: one has none
 * @property {number | null} corner angle at the second of three; null: there are two, or they coincide
 */

/** @param {Triple} a @param {Triple} b @returns {Triple} from b to a */
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @param {Triple} a @param {Triple} b @returns {number} */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Triple} a @param {Triple} b @returns {Triple} */
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
/** @param {Triple} a @returns {number} */
const length = (a) => Math.hypot(...a);

/**
 * @param {readonly Anchor[]} anchors two or three
 * @param {ReadonlyMap<string, Pose>} poses of the links in the root frame
 * @param {readonly JointView[]} joints
 * @returns {Measured | null} null: the robot has one of them no more
 */
export function measured(anchors, poses, joints) {
  const ends = anchors.flatMap((anchor) => placed(anchor, poses, joints) ?? []);
  const [first, second, third] = ends;
  if (ends.length < anchors.length || !first || !second) return null;
  const inRoot = minus(second.at, first.at);
  const firstPose = poses.get(first.anchor.link) ?? AT_REST;
  return {
    ends,
    distance: length(inRoot),
    inRoot,
    inFirst: turnedBack(firstPose, inRoot),
    toAxis: shortest(first, second),
    angle: first.direction && second.direction && angleBetween(first.direction, second.direction),
    corner: third ? angleBetween(minus(first.at, second.at), minus(third.at, second.at)) : null,
  };
}

/** @param {Anchor} anchor @param {ReadonlyMap<string, Pose>} poses @param {readonly JointView[]} joints @returns {Placed | null} */
function placed(anchor, poses, joints) {
  const pose = poses.get(anchor.link);
  if (!pose) return null;
  if (anchor.kind === "point")
    return {
      anchor,
      at: moved(pose, anchor.at),
      direction: anchor.normal && turned(pose, anchor.normal),
    };
  const at = translationOf(pose);
  if (anchor.kind === "frame") return { anchor, at, direction: turned(pose, [0, 0, 1]) };
  const joint = joints.find(({ name }) => name === anchor.joint);
  if (joint?.child !== anchor.link) return null;
  return { anchor, at, direction: turned(pose, joint.axis) };
}

/** @param {Triple} a @param {Triple} b @returns {number | null} rad, 0 to pi; exact for small ones too; null: one has no length */
export function angleBetween(a, b) {
  if (length(a) === 0 || length(b) === 0) return null;
  return Math.atan2(length(cross(a, b)), dot(a, b));
}

/** Below this sine two axes are parallel. */
const PARALLEL = 1e-9;

/** @param {Placed} one @param {Placed} other @returns {number | null} */
function shortest(one, other) {
  const between = minus(other.at, one.at);
  const [a, b] = [lineOf(one), lineOf(other)];
  if (a && b) {
    const across = cross(a, b);
    if (length(across) > PARALLEL) return Math.abs(dot(between, across)) / length(across);
  }
  const line = a ?? b;
  return line && length(cross(between, line));
}

/** @param {Placed} one @returns {Triple | null} where the axis points, of length 1; null: it is no axis */
function lineOf({ anchor, direction }) {
  if (anchor.kind !== "axis" || !direction) return null;
  const size = length(direction);
  return size > 0 ? [direction[0] / size, direction[1] / size, direction[2] / size] : null;
}

/**
 * @param {JointView[] | readonly JointView[]} joints
 * @param {string} part `link:<name>` or `joint:<name>`
 * @returns {Anchor | null} the frame of a link, the axis of a joint that has one, else the frame of its child
 */
export function anchorOfPart(joints, part) {
  const at = part.indexOf(":");
  const name = part.slice(at + 1);
  if (part.startsWith("link:")) return { kind: "frame", link: name };
  if (!part.startsWith("joint:")) return null;
  const joint = joints.find((one) => one.name === name);
  if (!joint) return null;
  const turns = ["revolute", "continuous", "prismatic"].includes(joint.type);
  return turns
    ? { kind: "axis", link: joint.child, joint: name }
    : { kind: "frame", link: joint.child };
}

/** @param {Anchor} anchor @returns {string} what it is called by: its joint, or its link */
export const anchorName = (anchor) => (anchor.kind === "axis" ? anchor.joint : anchor.link);

/** @param {Anchor} one @param {Anchor} other @returns {boolean} */
export const sameAnchor = (one, other) => JSON.stringify(one) === JSON.stringify(other);

/**
 * @typedef {object} Units
 * @property {boolean} millimetres
 * @property {boolean} degrees
 */

/** @typedef {(value: number) => string} Write with how many digits */

/** @param {readonly number[]} values m @param {Units} units @param {Write} write @returns {string} with their unit */
export const lengthsText = (values, { millimetres }, write = shownMeasure) => {
  const texts = values.map((value) => write(millimetres ? value * 1000 : value));
  return `${texts.join("  ")} ${millimetres ? "mm" : "m"}`;
};

/** @param {number} value m @param {Units} units @param {Write} write @returns {string} with its unit */
export const lengthText = (value, units, write = shownMeasure) =>
  lengthsText([value], units, write);

/** @param {number} value rad @param {Units} units @param {Write} write @returns {string} with its unit */
export const angleText = (value, { degrees }, write = shownMeasure) =>
  degrees ? `${write(toDegrees(value))}°` : `${write(value)} rad`;
