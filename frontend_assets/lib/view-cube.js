/** A cube that stands in the world as the camera sees it: its faces, and where its parts lead. */

/** @import { Triple, Turn } from "./view-poses.js" */

import { plus, times } from "./vectors.js";
import { turned } from "./view-poses.js";

/** @typedef {{name: string, out: Triple, right: Triple, up: Triple, transform: string}} Face `right` and `up` as they are seen from before it */

/** Seen as axis views show them. @type {readonly (readonly [string, Triple, Triple, Triple])[]} */
const SIDES = [
  ["front", [1, 0, 0], [0, 1, 0], [0, 0, 1]],
  ["back", [-1, 0, 0], [0, -1, 0], [0, 0, 1]],
  ["left", [0, 1, 0], [-1, 0, 0], [0, 0, 1]],
  ["right", [0, -1, 0], [1, 0, 0], [0, 0, 1]],
  ["top", [0, 0, 1], [1, 0, 0], [0, 1, 0]],
  ["bottom", [0, 0, -1], [1, 0, 0], [0, -1, 0]],
];

/** CSS's matrix from its columns, each three numbers, and how far it moves.
 * @param {Triple} x @param {Triple} y @param {Triple} z @param {string} [more] */
const matrix = (x, y, z, more = "") =>
  `matrix3d(${[...x, 0, ...y, 0, ...z, 0].map((one) => one.toFixed(5)).join()},0,0,0,1)${more}`;

/** @type {readonly Face[]} */
export const FACES = SIDES.map(([name, out, right, up]) => ({
  ...{ name, out, right, up },
  transform: matrix(right, times(up, -1), out, " translateZ(calc(var(--cube) / 2))"),
}));

const STEPS = /** @type {const} */ ([-1, 0, 1]);

/** The nine parts of a face by rows from its top: its middle, its edges and its corners, each with the
 * way from the middle of the cube to it. @param {Face} face @returns {{direction: Triple, isMiddle: boolean}[]} */
export function cellsOf({ out, right, up }) {
  return STEPS.toReversed().flatMap((row) =>
    STEPS.map((column) => ({
      direction: rounded(plus(out, plus(times(right, column), times(up, row)))),
      isMiddle: row === 0 && column === 0,
    })),
  );
}

/** @param {Triple} triple @returns {Triple} without -0 */
const rounded = ([x, y, z]) => [Math.round(x) + 0, Math.round(y) + 0, Math.round(z) + 0];

/** How the cube is turned for a camera: CSS's y points down. @param {Turn} turn of the camera */
export function cubeTransform([x, y, z, w]) {
  const back = /** @type {Turn} */ ([-x, -y, -z, w]);
  const [a, b, c] = /** @type {const} */ ([
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ]).map((axis) => {
    const [right, up, near] = turned(back, axis);
    return /** @type {Triple} */ ([right, -up, near]);
  });
  return matrix(a ?? [1, 0, 0], b ?? [0, 1, 0], c ?? [0, 0, 1]);
}

/** The face that is seen best. @param {Turn} turn of the camera */
export function nearestSide(turn) {
  const [x, y, z] = turned(turn, [0, 0, 1]);
  const along = (/** @type {Triple} */ [u, v, w]) => x * u + y * v + z * w;
  return FACES.reduce((best, face) => (along(face.out) > along(best.out) ? face : best)).name;
}

const EIGHTH = Math.PI / 4;

/** Where an arrow key leads from where we look: an eighth of a turn on; Home leads to a corner.
 * @param {Turn} turn of the camera @param {string} key @returns {Triple | null} */
export function stepped(turn, key) {
  if (key === "Home") return [1, -0.8, 0.62];
  /** @type {Record<string, readonly [number, number]>} */
  const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const step = steps[key];
  if (!step) return null;
  const [x, y, z] = turned(turn, [0, 0, 1]);
  const [rightX, rightY] = turned(turn, [1, 0, 0]);
  // Above or below, the picture's right says which yaw it is.
  const yaw = Math.hypot(x, y) > 0.01 ? Math.atan2(y, x) : Math.atan2(-rightX, rightY);
  const pitch = Math.asin(Math.min(Math.max(z, -1), 1));
  const to = Math.min(Math.max(Math.round(pitch / EIGHTH) + step[1], -2), 2) * EIGHTH;
  const about = (Math.round(yaw / EIGHTH) + step[0]) * EIGHTH;
  // Straight down, a little of the yaw is kept: the picture shall not turn about itself.
  const level = Math.max(Math.cos(to), 0.0008);
  return [Math.cos(about) * level, Math.sin(about) * level, Math.sin(to)];
}
