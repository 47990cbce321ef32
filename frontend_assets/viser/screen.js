/** @import { Door } from "./door.js" */
/** @import { Vector3 } from "./viser.d.ts" */

/** @typedef {[number, number]} Place px from the upper left corner of the picture */

/** Where a point of the scene is seen; null: behind the eye, or there is no picture.
 * @param {Door} door @param {Vector3} point @returns {Place | null} */
export function placeOf(door, point) {
  const { canvas, camera } = door.mutable ?? {};
  if (!canvas || !camera) return null;
  const eye = point.clone().setFromMatrixPosition(camera.matrixWorld);
  const back = point.clone().setFromMatrixColumn(camera.matrixWorld, 2);
  if (point.clone().sub(eye).dot(back) > -camera.near) return null;
  const seen = point.clone().project(camera);
  const frame = canvas.getBoundingClientRect();
  return [
    frame.left + ((seen.x + 1) / 2) * frame.width,
    frame.top + ((1 - seen.y) / 2) * frame.height,
  ];
}

/** @param {Place} a @param {Place} b */
export function pixelsBetween(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

/** @param {Place} place @param {Place} begin @param {Place} end @returns {number} px to the nearest place of the line between them */
export function pixelsToLine(place, begin, end) {
  const [wayX, wayY] = [end[0] - begin[0], end[1] - begin[1]];
  const length2 = wayX * wayX + wayY * wayY;
  const along = (place[0] - begin[0]) * wayX + (place[1] - begin[1]) * wayY;
  const share = length2 > 0 ? Math.min(Math.max(along / length2, 0), 1) : 0;
  return pixelsBetween(place, [begin[0] + share * wayX, begin[1] + share * wayY]);
}
