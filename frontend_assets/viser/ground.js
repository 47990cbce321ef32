/** @import { Door } from "./door.js" */
/** @import { Vector3 } from "./viser.d.ts" */

import { rayThrough } from "./picking.js";

/** m; what is farther is a mouse near the horizon. */
const FAR_M = 1e5;

/** @typedef {[number, number]} Ground x and y in the fixed frame, m */

/** The place of the ground (z = 0 of the fixed frame) under a place of the window; null: there is only sky.
 * @param {Door} door @param {number} x @param {number} y @returns {Ground | null} */
export function groundAt(door, x, y) {
  const ray = rayThrough(door, x, y);
  const origin = ray && inFixedFrame(door, ray.origin);
  const ahead = ray && inFixedFrame(door, ray.origin.clone().add(ray.direction));
  if (!origin || !ahead) return null;
  const direction = [0, 1, 2].map((axis) => at(ahead, axis) - at(origin, axis));
  const distance = -origin[2] / at(direction, 2);
  if (!(distance > 0 && distance < FAR_M)) return null;
  return [origin[0] + distance * at(direction, 0), origin[1] + distance * at(direction, 1)];
}

/** A place of the scene in the fixed frame, m. @param {Door} door @param {Vector3} point
 * @returns {[number, number, number] | null} */
export function inFixedFrame(door, point) {
  const matrix = door.node("")?.matrixWorld;
  if (!matrix) return null;
  const { x, y, z } = point.clone().applyMatrix4(matrix.clone().invert());
  return [x, y, z];
}

/** A place of the fixed frame in the scene. @param {Door} door @param {readonly [number, number, number]} place
 * @returns {Vector3 | null} */
export function fromFixedFrame(door, place) {
  const [matrix, camera] = [door.node("")?.matrixWorld, door.mutable?.camera];
  if (!matrix || !camera) return null;
  return camera.position
    .clone()
    .set(...place)
    .applyMatrix4(matrix);
}

/** @param {readonly number[]} parts @param {number} axis */
const at = (parts, axis) => /** @type {number} */ (parts[axis]);
