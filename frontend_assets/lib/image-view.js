/** How a picture lies in its frame: as large as fits, or as a person moved it. */

/** @import { Size, View } from "./pan-zoom.js" */

/** A pixel is a square that can be seen then. */
export const CLOSEST = 64;
/** The largest picture that is shown is no larger than a panel then. */
export const FARTHEST = 0.01;

/** @param {Size} picture @param {Size} frame @returns {View} all of it, in the middle, as large as it can be */
export function filling(picture, frame) {
  const wide = frame.width / Math.max(picture.width, 1);
  const high = frame.height / Math.max(picture.height, 1);
  const scale = Math.min(CLOSEST, wide, high);
  const middle = (/** @type {number} */ inner, /** @type {number} */ outer) =>
    (outer - inner * scale) / 2;
  return { x: middle(picture.width, frame.width), y: middle(picture.height, frame.height), scale };
}

/** @param {View} view @param {{x: number, y: number}} point in the frame @returns {{x: number, y: number}} column and row of the pixel there */
export function pixelUnder(view, point) {
  return {
    x: Math.floor((point.x - view.x) / view.scale),
    y: Math.floor((point.y - view.y) / view.scale),
  };
}

/** More pixels than a large screen has are not painted: what they would show is not seen. */
const PIXELS_MAX = 4_000_000;

/** @param {Size} frame @param {number} device pixels of the screen to one px @returns {number} pixels of the canvas to one px */
export function ratioFor({ width, height }, device) {
  return Math.min(device, Math.sqrt(PIXELS_MAX / Math.max(width * height, 1)));
}

/** @param {readonly number[]} times_s of what came last, the oldest first @returns {number | null} how many come in a second; null: that cannot be told */
export function rateOf(times_s) {
  const span_s = (times_s.at(-1) ?? 0) - (times_s[0] ?? 0);
  return times_s.length > 1 && span_s > 0 ? (times_s.length - 1) / span_s : null;
}
