/** The part of a picture that is seen: for each pixel of the screen, which pixel of the picture. */

/** @import { Size, View } from "./pan-zoom.js" */

import { filling } from "./image-view.js";

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
