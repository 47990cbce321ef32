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

/**
 * @typedef {object} Sight where a picture is looked at
 * @property {number} width of the canvas, in its own pixels
 * @property {number} height
 * @property {number} ratio of these to one px of the page
 * @property {View | null} view in px of the page; null: all of the picture, as large as it can be
 */

/**
 * @typedef {object} Window
 * @property {number} left the first column of the canvas with something of the picture
 * @property {number} top
 * @property {Int32Array} columns of the picture, for each column of the canvas from there on
 * @property {Int32Array} rows
 */

/** @param {Size} picture @param {Sight} sight @returns {View} of it in pixels of the canvas */
export function viewWithin(picture, { width, height, ratio, view }) {
  const frame = { width: width / ratio, height: height / ratio };
  const { x, y, scale } = view ?? filling(picture, frame);
  return { x: x * ratio, y: y * ratio, scale: scale * ratio };
}

/**
 * @param {Size} picture
 * @param {View} view in pixels of the canvas
 * @param {Size} canvas
 * @param {number} [parts] so many columns and rows for each one of the canvas
 * @returns {Window} without columns or rows: nothing of it is seen
 */
export function windowOf(picture, { x, y, scale }, canvas, parts = 1) {
  const [left, columns] = along(x, scale, picture.width, canvas.width, parts);
  const [top, rows] = along(y, scale, picture.height, canvas.height, parts);
  return { left, top, columns, rows };
}

/** @param {Size} picture @returns {Window} each pixel of it, once */
export function wholeOf({ width, height }) {
  const each = (/** @type {number} */ length) => Int32Array.from({ length }, (_, n) => n);
  return { left: 0, top: 0, columns: each(width), rows: each(height) };
}

/**
 * Of a row of `length` pixels, each `scale` long, from `begin` on: those under the middles of the
 * pixels of the canvas.
 *
 * @param {number} begin @param {number} scale @param {number} length @param {number} room @param {number} parts
 * @returns {[number, Int32Array]} the first pixel of the canvas, and what each shows
 */
function along(begin, scale, length, room, parts) {
  const start = Math.ceil(begin - 0.5);
  // What is thinner than a pixel of the canvas has one nevertheless.
  const end = Math.max(start + 1, Math.ceil(begin + length * scale - 0.5));
  const first = Math.max(0, start);
  const count = Math.max(0, Math.min(end, room) - first);
  const shown = new Int32Array(Number.isFinite(count) ? count * parts : 0);
  for (let n = 0; n < shown.length; n += 1) {
    const at = Math.floor((first + (n + 0.5) / parts - begin) / scale);
    shown[n] = Math.max(0, Math.min(length - 1, at));
  }
  return [first, shown];
}

/** Two of four bytes, with room for the sum of four of each. */
const EVERY_OTHER = 0x00ff00ff;
/** Halves are rounded up. */
const HALVES = 0x00020002;

/**
 * @param {Uint32Array} fine RGBA, two columns and two rows for each pixel
 * @param {Uint32Array} packed RGBA, of which every pixel is the middle of its four
 * @param {number} width of `packed`
 */
export function average(fine, packed, width) {
  for (let begin = 0; begin < packed.length; begin += width)
    averageRow(fine, 4 * begin, packed, begin, width);
}

/** @param {Uint32Array} fine @param {number} from @param {Uint32Array} packed @param {number} to @param {number} width */
function averageRow(fine, from, packed, to, width) {
  for (let n = 0; n < width; n += 1) {
    const at = from + 2 * n;
    packed[to + n] = middleOf(
      fine[at] ?? 0,
      fine[at + 1] ?? 0,
      fine[at + 2 * width] ?? 0,
      fine[at + 2 * width + 1] ?? 0,
    );
  }
}

/** @param {number} a @param {number} b @param {number} c @param {number} d @returns {number} */
function middleOf(a, b, c, d) {
  const lower =
    (a & EVERY_OTHER) + (b & EVERY_OTHER) + (c & EVERY_OTHER) + (d & EVERY_OTHER) + HALVES;
  const upper =
    ((a >>> 8) & EVERY_OTHER) +
    ((b >>> 8) & EVERY_OTHER) +
    ((c >>> 8) & EVERY_OTHER) +
    ((d >>> 8) & EVERY_OTHER) +
    HALVES;
  return ((lower >>> 2) & EVERY_OTHER) | (((upper >>> 2) & EVERY_OTHER) << 8);
}
