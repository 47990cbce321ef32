/** @import { Door } from "./door.js" */
/** @import { Object3D, Vector3 } from "./viser.d.ts" */

import { boxCorners } from "./robot.js";
import { cross, plus } from "../lib/vectors.js";

const ROOT = "/live/";
/** So many places of one node are looked at, spread over all of them. */
const LOOKED_AT = 4000;
/** Of so many, a few that lie apart are not waited for: a stray return of a lidar is no wall. */
const MANY = 100;
const STRAY = 0.01;
/** m; what is farther from its frame is seen by no camera. */
const FAR_M = 1e5;
/** Grids have no end, and words have a size on the screen. */
const NO_EXTENT = new Set(["GridMessage", "LabelMessage", "FrameMessage"]);

/** @typedef {[number, number, number]} Triple */
/** @typedef {ArrayLike<number>} Numbers */
/**
 * What is read of a node: ends of lines and points of clouds; or of batched solids and axes.
 * @typedef {object} Props
 * @property {Numbers} [points] (N, 3)
 * @property {Numbers} [batched_positions] (N, 3)
 * @property {Numbers} [batched_wxyzs] (N, 4)
 * @property {Numbers | null} [batched_scales] (N, 3)
 * @property {Numbers} [vertices] (V, 3) of the solid that there are many of
 * @property {number} [axes_length]
 * @property {string} [font_size_mode] it is words
 */

/** Where all that displays draw reaches, for a camera that shall see it. */
export class LiveExtent {
  #door;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
  }

  /** Corners of boxes around what is seen of each node, in the axes of three.js. @returns {Vector3[]} */
  corners() {
    /** @type {Vector3[]} */
    const found = [];
    for (const [name, node] of Object.entries(window.__viserSceneTree?.getState() ?? {})) {
      const object = name.startsWith(ROOT) ? this.#door.node(name) : undefined;
      if (!node || !object || NO_EXTENT.has(node.message.type) || !isSeen(object)) continue;
      object.updateWorldMatrix(true, true);
      found.push(...cornersOf(object, /** @type {Props} */ (node.message.props ?? {})));
    }
    return found.length > LOOKED_AT ? around(found) : found;
  }
}

/** Corners of one box around all. @param {Vector3[]} points @returns {Vector3[]} */
function around(points) {
  const box = boxOf(points.map(({ x, y, z }) => [x, y, z]));
  const [first] = points;
  return box && first ? cornersOfBox(box).map((corner) => first.clone().set(...corner)) : [];
}

/** @param {Object3D} object @param {Props} props @returns {Vector3[]} */
function cornersOf(object, props) {
  if (props.font_size_mode) return [];
  if (!props.points && !props.batched_positions) return meshCorners(object);
  const box = boxOf(placesOf(props));
  const corners = box ? cornersOfBox(box) : [];
  return corners.map((corner) =>
    object.position
      .clone()
      .set(...corner)
      .applyMatrix4(object.matrixWorld),
  );
}

/** @param {Object3D} object @returns {Vector3[]} */
function meshCorners(object) {
  /** @type {Vector3[]} */
  const found = [];
  object.traverseVisible((one) => {
    if (one.isMesh) found.push(...boxCorners(one));
  });
  return found.filter(({ x, y, z }) => [x, y, z].every(isNear));
}

/** Where the parts of a node are, in its own axes. @param {Props} props @returns {Triple[]} */
export function placesOf(props) {
  const { points, batched_positions: middles, batched_wxyzs: turns, batched_scales: scales } = props;
  if (points) return spread(points).map((row) => tripleAt(points, row));
  if (!middles) return [];
  const corners = cornersOfOne(props);
  return spread(middles, corners.length).flatMap((row) => {
    const scale = scales ? tripleAt(scales, row) : ONES;
    return corners.map(([x, y, z]) => {
      /** @type {Triple} */
      const grown = [x * scale[0], y * scale[1], z * scale[2]];
      return plus(tripleAt(middles, row), turns ? turned(turns, row, grown) : grown);
    });
  });
}

/** @type {Triple} */
const ONES = [1, 1, 1];

/** Rows of (N, 3) numbers to be looked at. @param {Numbers} numbers @param {number} [each] places of one row */
function spread(numbers, each = 1) {
  const count = Math.floor(numbers.length / 3);
  const step = Math.max(1, Math.ceil((count * each) / LOOKED_AT));
  return Array.from({ length: Math.ceil(count / step) }, (_, at) => at * step);
}

/** Of one of the many: of a cross where it ends, else of a box around it. @param {Props} props @returns {Triple[]} */
function cornersOfOne({ vertices, axes_length: length }) {
  if (length !== undefined)
    return [
      [0, 0, 0],
      [length, 0, 0],
      [0, length, 0],
      [0, 0, length],
    ];
  const box = vertices && boxOf(spread(vertices).map((row) => tripleAt(vertices, row)));
  return box ? cornersOfBox(box) : [[0, 0, 0]];
}

/** @param {[Triple, Triple]} box @returns {Triple[]} */
function cornersOfBox(box) {
  return box.flatMap(([x]) =>
    box.flatMap(([, y]) => box.map(([, , z]) => /** @type {Triple} */ ([x, y, z]))),
  );
}

/** The least and the greatest of places that are near, without a few strays of many; null: none is.
 * @param {readonly Triple[]} places @returns {[Triple, Triple] | null} */
export function boxOf(places) {
  const near = places.filter((place) => place.every(isNear));
  if (near.length === 0) return null;
  const strays = near.length < MANY ? 0 : Math.floor(near.length * STRAY);
  const [x, y, z] = columns(near);
  const at = (/** @type {number} */ rank) =>
    /** @type {Triple} */ ([x.at(rank), y.at(rank), z.at(rank)]);
  return [at(strays), at(-1 - strays)];
}

/** Each axis by itself, from the least. @param {readonly Triple[]} places */
function columns(places) {
  const column = (/** @type {0 | 1 | 2} */ axis) =>
    Float64Array.from(places, (place) => place[axis]).sort();
  return /** @type {const} */ ([column(0), column(1), column(2)]);
}

/** @param {number} part */
const isNear = (part) => Math.abs(part) < FAR_M;

/** @param {Numbers} turns unit quaternions @param {number} row @param {Triple} place @returns {Triple} */
function turned(turns, row, place) {
  const [w = 1, x = 0, y = 0, z = 0] = Array.from({ length: 4 }, (_, at) => turns[4 * row + at]);
  const twice = cross([x, y, z], place).map((part) => 2 * part);
  const aside = /** @type {Triple} */ (twice);
  const [ax, ay, az] = cross([x, y, z], aside);
  return plus(place, [w * aside[0] + ax, w * aside[1] + ay, w * aside[2] + az]);
}

/** @param {Numbers} numbers @param {number} row @returns {Triple} */
function tripleAt(numbers, row) {
  const part = (/** @type {number} */ axis) => {
    const number = numbers[3 * row + axis] ?? Number.NaN;
    return numbers instanceof Uint16Array ? fromHalf(number) : number;
  };
  return [part(0), part(1), part(2)];
}

/** A number of half precision from its bits. @param {number} bits */
export function fromHalf(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 0x1f;
  const fraction = bits & 0x3ff;
  if (exponent === 0x1f) return fraction ? Number.NaN : sign * Number.POSITIVE_INFINITY;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

/**
 * Whether an object and all above it are shown.
 * @param {Object3D | null | undefined} object
 */
export function isSeen(object) {
  if (!object) return false;
  let above = /** @type {Object3D | null} */ (object);
  while (above?.visible) above = above.parent;
  return above === null;
}
