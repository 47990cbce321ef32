/** @import { Door } from "./door.js" */
/** @import { Matrix4, Object3D, Vector3 } from "./viser.d.ts" */

/** @typedef {ArrayLike<number>} Numbers */
/** A rectangle of the window, px. @typedef {{ left: number, top: number, right: number, bottom: number }} Rect */
/** Places on the screen, px: x and y one after the other. @typedef {Float64Array | number[]} Seen */

/**
 * Where places of one node are seen in the window, by the camera's own matrices: it may be one of
 * perspective or not. `at` gives nothing for what is behind an eye with perspective.
 */
export class Lens {
  /** px from the left edge of the window and from its upper edge, and m in front of the camera. */
  x = 0;
  y = 0;
  depth_m = 0;
  /** How many pixels a metre is there. */
  perMetre = 0;
  // Rows of what leads to each, for a million of points are asked for.
  #x;
  #y;
  #w;
  #depth;
  #upward_px;

  /**
   * @param {Numbers} clip of three.js: from the axes of the node to the picture, 16 numbers, column by column
   * @param {Numbers} view from there to the camera's axes
   * @param {{ left: number, top: number, width: number, height: number }} frame of the picture in the window
   * @param {number} upward of the projection: how a metre up is seen at depth 1
   */
  constructor(clip, view, { left, top, width, height }, upward) {
    const [right, up, , w] = [0, 1, 2, 3].map((at) => rowOf(clip, at));
    this.#w = /** @type {Row} */ (w);
    this.#x = /** @type {Row} */ (
      this.#w.map((part, at) => left * part + ((part + (right?.[at] ?? 0)) * width) / 2)
    );
    this.#y = /** @type {Row} */ (
      this.#w.map((part, at) => top * part + ((part - (up?.[at] ?? 0)) * height) / 2)
    );
    this.#depth = /** @type {Row} */ (rowOf(view, 2).map((part) => -part));
    this.#upward_px = (Math.abs(upward) * height) / 2;
  }

  /** @param {number} x @param {number} y @param {number} z in the axes of the node @returns {boolean} whether it is seen, in the picture or beside it */
  at(x, y, z) {
    const depth = this.#depth;
    this.depth_m = depth[0] * x + depth[1] * y + depth[2] * z + depth[3];
    const own = this.#w;
    const w = own[0] * x + own[1] * y + own[2] * z + own[3];
    // Without perspective all is seen that lies between the planes, beside the eye and behind it, too.
    if (!(w > 0)) return false;
    const [right, down] = [this.#x, this.#y];
    this.x = (right[0] * x + right[1] * y + right[2] * z + right[3]) / w;
    this.y = (down[0] * x + down[1] * y + down[2] * z + down[3]) / w;
    this.perMetre = this.#upward_px / w;
    return true;
  }
}

/** @typedef {[number, number, number, number]} Row */

/** @param {Numbers} matrix column by column @param {number} row @returns {Row} */
const rowOf = (matrix, row) => [
  matrix[row] ?? 0,
  matrix[row + 4] ?? 0,
  matrix[row + 8] ?? 0,
  matrix[row + 12] ?? 0,
];

/** The lens for what is said in the axes of an object; null: there is no picture. @param {Door} door @param {Object3D} object */
export function lensOf(door, object) {
  const { canvas, camera } = door.mutable ?? {};
  if (!canvas || !camera) return null;
  const view = camera.matrixWorld.clone().invert().multiply(object.matrixWorld);
  const clip = camera.projectionMatrix.clone().multiply(view);
  const upward = camera.projectionMatrix.elements[5] ?? 1;
  return new Lens(clip.elements, view.elements, canvas.getBoundingClientRect(), upward);
}

/** @param {Matrix4} matrix @param {Vector3} point @returns {[number, number, number]} the point in the axes that the matrix is of */
export function inside(matrix, point) {
  const { x, y, z } = point.clone().applyMatrix4(matrix.clone().invert());
  return [x, y, z];
}

/** @param {{ x: number, y: number }} a @param {{ x: number, y: number }} b @returns {Rect} */
export function rectOf(a, b) {
  return {
    left: Math.min(a.x, b.x),
    top: Math.min(a.y, b.y),
    right: Math.max(a.x, b.x),
    bottom: Math.max(a.y, b.y),
  };
}

/** @param {Rect} rect @param {number} x @param {number} y */
export const isIn = ({ left, top, right, bottom }, x, y) =>
  x >= left && x <= right && y >= top && y <= bottom;

/**
 * Whether a rectangle and a convex shape touch: no line lies between them that is parallel to a side of
 * either. Sides beside the first ones may be left out: then some that only come near do, too.
 * @param {Rect} rect @param {Seen} corners of the shape @param {Seen} sides from corner to corner: x and y each
 */
export function touches(rect, corners, sides) {
  if (apart(rect, corners, 1, 0) || apart(rect, corners, 0, 1)) return false;
  for (let at = 0; at < sides.length; at += 2)
    if (
      apart(
        rect,
        corners,
        -(/** @type {number} */ (sides[at + 1])),
        /** @type {number} */ (sides[at]),
      )
    )
      return false;
  return true;
}

/** @param {Rect} rect @param {Seen} corners @param {number} x @param {number} y of the direction that is looked along */
function apart({ left, top, right, bottom }, corners, x, y) {
  const [middle, reach] = [
    (x * (left + right) + y * (top + bottom)) / 2,
    (Math.abs(x) * (right - left) + Math.abs(y) * (bottom - top)) / 2,
  ];
  let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
  for (let at = 0; at < corners.length; at += 2) {
    const along =
      x * /** @type {number} */ (corners[at]) + y * /** @type {number} */ (corners[at + 1]);
    low = Math.min(low, along);
    high = Math.max(high, along);
  }
  return low > middle + reach || high < middle - reach;
}
