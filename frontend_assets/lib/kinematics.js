/**
 * Where the links of a robot stand: joint frames and positions in, poses out. `a_from_b` is a pose
 * of b in a: it takes points of b to points of a.
 */

/** @import { JointView } from "../types/wire.d.ts" */

/** Three rows of a rotation and a translation in m: x' = p[0] x + p[1] y + p[2] z + p[3], and so on. @typedef {readonly number[]} Pose */
/** @typedef {readonly [number, number, number]} Triple */
/** x, y, z in m, then roll, pitch, yaw about fixed axes in rad, as in URDF. @typedef {readonly [number, number, number, number, number, number]} Origin */

/** @type {Pose} */
export const AT_REST = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

/** @param {Origin} origin @returns {Pose} */
export function poseOf([x, y, z, roll, pitch, yaw]) {
  const [sr, sp, sy] = [Math.sin(roll), Math.sin(pitch), Math.sin(yaw)];
  const [cr, cp, cy] = [Math.cos(roll), Math.cos(pitch), Math.cos(yaw)];
  return [
    ...[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x],
    ...[sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, y],
    ...[-sp, cp * sr, cp * cr, z],
  ];
}

/** @param {Pose} pose @param {number} at @returns {number} one of its numbers */
const n = (pose, at) => /** @type {number} */ (pose[at]);

/** @param {Pose} aFromB @param {Pose} bFromC @returns {Pose} of c in a */
export function compose(aFromB, bFromC) {
  const found = [];
  for (const row of [0, 4, 8]) {
    const [x, y, z] = [n(aFromB, row), n(aFromB, row + 1), n(aFromB, row + 2)];
    for (let column = 0; column < 4; column += 1) {
      const moved = column === 3 ? n(aFromB, row + 3) : 0;
      found.push(
        x * n(bFromC, column) + y * n(bFromC, 4 + column) + z * n(bFromC, 8 + column) + moved,
      );
    }
  }
  return found;
}

/** @param {Pose} aFromB @returns {Pose} of a in b */
export function inverse(aFromB) {
  const turned = turnedBack(aFromB, translationOf(aFromB));
  return [0, 1, 2].flatMap((at) => [
    n(aFromB, at),
    n(aFromB, 4 + at),
    n(aFromB, 8 + at),
    -(/** @type {number} */ (turned[at])),
  ]);
}

/** @param {Pose} pose @returns {Triple} m */
export const translationOf = (pose) => [n(pose, 3), n(pose, 7), n(pose, 11)];

/** @param {Pose} aFromB @param {Triple} vector in b @returns {Triple} the same direction in a */
export function turned(aFromB, [x, y, z]) {
  const row = (/** @type {number} */ at) =>
    n(aFromB, at) * x + n(aFromB, at + 1) * y + n(aFromB, at + 2) * z;
  return [row(0), row(4), row(8)];
}

/** @param {Pose} aFromB @param {Triple} vector in a @returns {Triple} the same direction in b */
export function turnedBack(aFromB, [x, y, z]) {
  const column = (/** @type {number} */ at) =>
    n(aFromB, at) * x + n(aFromB, at + 4) * y + n(aFromB, at + 8) * z;
  return [column(0), column(1), column(2)];
}

/** @param {Pose} aFromB @param {Triple} point in b @returns {Triple} the same point in a */
export function moved(aFromB, point) {
  const [x, y, z] = turned(aFromB, point);
  return [x + n(aFromB, 3), y + n(aFromB, 7), z + n(aFromB, 11)];
}

/**
 * @param {Triple} axis of length 1
 * @param {number} angle rad
 * @returns {Pose} a turn about an axis through the origin
 */
export function turnAbout([x, y, z], angle) {
  const s = Math.sin(angle);
  // 1 - cos without the loss of digits at small angles
  const v = 2 * Math.sin(angle / 2) ** 2;
  return [
    ...[1 - v * (y * y + z * z), v * x * y - s * z, v * x * z + s * y, 0],
    ...[v * x * y + s * z, 1 - v * (x * x + z * z), v * y * z - s * x, 0],
    ...[v * x * z - s * y, v * y * z + s * x, 1 - v * (x * x + y * y), 0],
  ];
}

/** @param {Pick<JointView, "type" | "axis">} joint @param {number} position rad or m @returns {Pose} what it does to its child */
export function motionOf({ type, axis }, position) {
  if (type === "prismatic") {
    const [x, y, z] = axis;
    return [1, 0, 0, x * position, 0, 1, 0, y * position, 0, 0, 1, z * position];
  }
  return type === "revolute" || type === "continuous" ? turnAbout(axis, position) : AT_REST;
}

/**
 * Poses of all links in the root frame; every link without a parent stands at rest.
 *
 * @param {{links: readonly {name: string}[], joints: readonly JointView[]}} robot
 * @param {(joint: string) => Origin | undefined} originOf frame of a joint in its parent
 * @param {(joint: string) => number} positionOf rad or m
 * @returns {Map<string, Pose>} by link
 */
export function rootFromLinks({ links, joints }, originOf, positionOf) {
  const jointOf = new Map(joints.map((joint) => [joint.child, joint]));
  /** @type {Map<string, Pose>} */
  const found = new Map();
  for (const { name } of links) {
    const chain = wayUp(name, jointOf, found);
    for (const joint of chain.reverse()) {
      const origin = originOf(joint.name);
      const inParent = compose(
        origin ? poseOf(origin) : AT_REST,
        motionOf(joint, positionOf(joint.name)),
      );
      found.set(joint.child, compose(found.get(joint.parent) ?? AT_REST, inParent));
    }
    if (!found.has(name)) found.set(name, AT_REST);
  }
  return found;
}

/**
 * @param {string} link
 * @param {ReadonlyMap<string, JointView>} jointOf by child
 * @param {ReadonlyMap<string, Pose>} known
 * @returns {JointView[]} the joints above a link, up to the first link that is known
 */
function wayUp(link, jointOf, known) {
  const way = [];
  const seen = new Set();
  let at = link;
  while (!known.has(at) && !seen.has(at)) {
    seen.add(at);
    const joint = jointOf.get(at);
    if (!joint) break;
    way.push(joint);
    at = joint.parent;
  }
  return way;
}
