/** @import { Object3D } from "./viser.d.ts" */

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
