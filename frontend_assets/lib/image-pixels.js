/**
 * Raw images of cameras, whatever their encoding: the bytes of a message to what can be shown.
 *
 * Of an image only what is seen is painted: its bytes are looked at where they are.
 */

/** @import { Window } from "./image-window.js" */

import { channelInk, greyInk } from "./image-colors.js";
import { mosaicInk, pairInk } from "./image-mosaics.js";
import { numberInk } from "./image-numbers.js";

/**
 * @typedef {object} RawImage as sensor_msgs/msg/Image has it
 * @property {number} width
 * @property {number} height
 * @property {string} encoding
 * @property {number} is_bigendian
 * @property {number} step bytes from row to row; 0: no more than the pixels need
 * @property {Uint8Array} data
 */

/** @typedef {{low: number, high: number}} Range from black to white */

/** @typedef {{range: Range, unit: string}} Numbers from the least to the largest that is measured; `unit` empty: they have none */

/**
 * @typedef {object} Ink how the pixels of one encoding are painted
 * @property {(window: Window, packed: Uint32Array, range: Range) => void} paint RGBA of every pixel of the window, row by row
 * @property {(x: number, y: number) => number[]} at what a pixel is: one number, or red, green and blue
 * @property {Numbers | null} numbers null: its pixels are colours
 */

/** @typedef {{raw: RawImage, row: number}} Rows an image of which every row is there; `row`: bytes from one to the next */

const SIDE_MAX = 16_384;
const PIXELS_MAX = 1 << 26;
const NAME_MAX = 60;

/** Why an image is not shown: a text of the catalogue, and what stands in it. */
export class ImageError extends Error {
  /** @param {string} key @param {Record<string, string | number>} [words] */
  constructor(key, words = {}) {
    super(key);
    this.key = key;
    this.words = words;
  }
}

/** @param {number} width @param {number} height @throws {ImageError} nothing can be drawn so large, or nothing is there */
export function checkSize(width, height) {
  const size = { width, height };
  if (width === 0 || height === 0) throw new ImageError("image.trouble.empty", size);
  if (Math.max(width, height) > SIDE_MAX || width * height > PIXELS_MAX)
    throw new ImageError("image.trouble.large", { ...size, side: SIDE_MAX });
}

/** @param {RawImage} raw @param {number} pixel bytes of one @returns {Rows} @throws {ImageError} some of it is not there */
function rowsOf(raw, pixel) {
  const { width, height, step, data } = raw;
  checkSize(width, height);
  const row = step || width * pixel;
  const needed = (height - 1) * row + width * pixel;
  if (row < width * pixel || needed > data.length)
    throw new ImageError("image.trouble.short", { width, height, row, bytes: data.length });
  return { raw, row };
}

const COLORS = /^(rgb|bgr|rgba|bgra)(8|16)$/;
const MATRIX = /^(8|16)UC([34])$/;
const NUMBERS = /^(?:(8)([US])|(16)([US])|(32)([SF])|(64)(F))(?:C1)?$/;
const MOSAIC = /^bayer_(rggb|bggr|gbrg|grbg)(8|16)$/;
/** Where the first brightness is in the two bytes of a pixel. @type {Map<string, number>} */
const PAIRS = new Map([
  ["yuv422", 1],
  ["uyvy", 1],
  ["yuv422_yuy2", 0],
  ["yuyv", 0],
]);
/** Greys, as the numbers that they are. @type {Map<string, string>} */
const GREYS = new Map([
  ["mono8", "8UC1"],
  ["mono16", "16UC1"],
]);

/** @param {RawImage} raw @returns {Ink} @throws {ImageError} it is not shown */
export function inkOf(raw) {
  const { encoding } = raw;
  const found = numbersOf(raw) ?? colorsOf(raw) ?? mosaicOf(raw);
  if (found) return found;
  const luma = PAIRS.get(encoding);
  if (luma !== undefined) return pairInk(rowsOf(raw, 2), luma);
  throw new ImageError("image.trouble.encoding", { encoding: encoding.slice(0, NAME_MAX) });
}

/** @param {RawImage} raw @returns {Ink | null} */
function numbersOf(raw) {
  const named = NUMBERS.exec(GREYS.get(raw.encoding) ?? raw.encoding);
  const [bits, kind] = named?.slice(1).filter(Boolean) ?? [];
  if (!bits) return null;
  const bytes = Number(bits) / 8;
  const rows = rowsOf(raw, bytes);
  return bits === "8" && kind === "U" ? greyInk(rows) : numberInk(rows, `${kind}${bytes}`);
}

/** @param {RawImage} raw @returns {Ink | null} */
function colorsOf(raw) {
  const [, letters, bits] = COLORS.exec(raw.encoding) ?? matrixOf(raw.encoding);
  if (!letters) return null;
  const bytes = Number(bits) / 8;
  return channelInk(rowsOf(raw, letters.length * bytes), letters, bytes);
}

/** @param {string} encoding as OpenCV names it: blue first @returns {string[]} as COLORS finds them */
function matrixOf(encoding) {
  const [, bits, channels] = MATRIX.exec(encoding) ?? [];
  return bits ? [encoding, channels === "4" ? "bgra" : "bgr", bits] : [];
}

/** @param {RawImage} raw @returns {Ink | null} */
function mosaicOf(raw) {
  const [, pattern, bits] = MOSAIC.exec(raw.encoding) ?? [];
  if (!pattern) return null;
  const bytes = Number(bits) / 8;
  return mosaicInk(rowsOf(raw, bytes), pattern, bytes);
}
