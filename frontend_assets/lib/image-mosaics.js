/** Images in which pixels share their colours: pairs of YUV 4:2:2, and squares of a Bayer sensor. */

/** @import { Ink, Rows } from "./image-pixels.js" */
/** @import { Window } from "./image-window.js" */

import { BLUE, GREEN, OPAQUE, RED } from "./image-colors.js";

/** Full range BT.601, as cameras send it over USB; in parts of 65,536, by a byte of U or V. */
const SHARES = [1.402, 0.714136, 0.344136, 1.772].map((share) =>
  Int32Array.from({ length: 256 }, (_, byte) => Math.round((byte - 128) * share * 65_536)),
);
const [RED_V, GREEN_V, GREEN_U, BLUE_U] =
  /** @type {[Int32Array, Int32Array, Int32Array, Int32Array]} */ (SHARES);
const HALF = 32_768;
/** U or V of a grey. */
const NO_COLOR = 128;
/** No sum is farther below a byte's least. */
const BELOW = 256;
/** What a sum becomes in a byte. */
const BYTES = Uint8Array.from({ length: 1024 }, (_, n) => Math.max(0, Math.min(255, n - BELOW)));

/**
 * @param {Rows} rows of two bytes for each pixel
 * @param {number} luma where the brightness is in them
 * @returns {Ink}
 */
export function pairInk({ raw: { width, data }, row }, luma) {
  const last = Math.max(0, (width & ~1) - 2);
  // One pixel alone has no V, whatever follows it.
  const toV = width > 1 ? 2 : data.length;
  // A row of odd width ends amid a pair: its last pixel has the colour of the pair before.
  const pairOf = (/** @type {number} */ x) => 2 * Math.min(x & ~1, last) + 1 - luma;
  return colorInk(({ columns, rows }, packed) => {
    const pairs = columns.map(pairOf);
    const lumas = columns.map((x) => 2 * x + luma);
    rows.forEach((line, n) => {
      paintPairs(packed, n * lumas.length, data, line * row, lumas, pairs, toV);
    });
  });
}

/** @param {Uint32Array} packed @param {number} to @param {Uint8Array} data @param {number} begin @param {Int32Array} lumas @param {Int32Array} pairs where their U is @param {number} toV from there */
function paintPairs(packed, to, data, begin, lumas, pairs, toV) {
  for (let n = 0; n < lumas.length; n += 1) {
    const u = begin + (pairs[n] ?? 0);
    const luminance = data[begin + (lumas[n] ?? 0)] ?? 0;
    packed[to + n] = colorOf(luminance, data[u] ?? NO_COLOR, data[u + toV] ?? NO_COLOR);
  }
}

/** @param {number} luminance @param {number} u @param {number} v @returns {number} RGBA */
function colorOf(luminance, u, v) {
  const y = (luminance << 16) + HALF;
  const red = (y + (RED_V[v] ?? 0)) >> 16;
  const green = (y - (GREEN_U[u] ?? 0) - (GREEN_V[v] ?? 0)) >> 16;
  const blue = (y + (BLUE_U[u] ?? 0)) >> 16;
  return OPAQUE | (byteOf(red) << RED) | (byteOf(green) << GREEN) | (byteOf(blue) << BLUE);
}

/** @param {number} sum @returns {number} */
const byteOf = (sum) => BYTES[sum + BELOW] ?? 0;

/**
 * Every square of 2 x 2 pixels gets the colour that its four measure: nothing is guessed.
 *
 * @param {Rows} rows
 * @param {string} pattern the colours of a square, row by row
 * @param {number} bytes of a pixel; of two the upper is shown
 * @returns {Ink}
 */
export function mosaicInk({ raw: { width, height, data, is_bigendian }, row }, pattern, bytes) {
  const upper = is_bigendian ? 0 : bytes - 1;
  const place = pattern.indexOf("r");
  const [redColumn, redRow] = [place & 1, place >> 1];
  const placeIn = (/** @type {number} */ x, /** @type {number} */ n) =>
    squareAt(x, n, width) * bytes + upper;
  return colorInk(({ columns, rows }, packed) => {
    // The others of a square are beside and below the red one: blue is across.
    const reds = columns.map((x) => placeIn(x, redColumn));
    const blues = columns.map((x) => placeIn(x, 1 - redColumn));
    rows.forEach((line, n) => {
      const red = squareAt(line, redRow, height) * row;
      const blue = squareAt(line, 1 - redRow, height) * row;
      paintSquares(packed, n * reds.length, data, red, reds, blue, blues);
    });
  });
}

/** @param {Uint32Array} packed @param {number} to @param {Uint8Array} data @param {number} red the row with red @param {Int32Array} reds the columns with red @param {number} blue @param {Int32Array} blues */
function paintSquares(packed, to, data, red, reds, blue, blues) {
  for (let n = 0; n < reds.length; n += 1) {
    const ofRed = reds[n] ?? 0;
    const ofBlue = blues[n] ?? 0;
    const green = ((data[red + ofBlue] ?? 0) + (data[blue + ofRed] ?? 0)) >> 1;
    packed[to + n] =
      OPAQUE |
      ((data[red + ofRed] ?? 0) << RED) |
      (green << GREEN) |
      ((data[blue + ofBlue] ?? 0) << BLUE);
  }
}

/** @param {number} at @param {number} n of two @param {number} length @returns {number} a column or row of the square that `at` is in: a whole one, where there is any */
function squareAt(at, n, length) {
  const begin = Math.min(at & ~1, Math.max(0, (length & ~1) - 2));
  return Math.min(begin + n, length - 1);
}
/** @param {(window: Pick<Window, "columns" | "rows">, packed: Uint32Array) => void} paint @returns {Ink} whose pixels are what is shown of them */
function colorInk(paint) {
  return {
    numbers: null,
    paint,
    at(x, y) {
      const packed = new Uint32Array(1);
      paint({ columns: Int32Array.of(x), rows: Int32Array.of(y) }, packed);
      return [...new Uint8Array(packed.buffer).subarray(0, 3)];
    },
  };
}
