/** Images whose pixels each have their own colour, or their own grey in one byte. */

/** @import { Ink, Rows } from "./image-pixels.js" */

/** Whether the first byte of a number is its least, on this machine. */
export const IS_LITTLE = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;
/** How far to the left each of them stands in the four bytes of a pixel, taken as one number. */
export const [RED, GREEN, BLUE, ALPHA] = IS_LITTLE ? [0, 8, 16, 24] : [24, 16, 8, 0];
export const OPAQUE = 255 << /** @type {number} */ (ALPHA);
/** A grey of one, to be multiplied. */
export const GREY = (1 << /** @type {number} */ (RED)) | (1 << GREEN) | (1 << BLUE);

/** @param {Rows} rows @param {string} letters the order of the channels @param {number} bytes of each; of two the upper is shown @returns {Ink} */
export function channelInk({ raw: { data, is_bigendian }, row }, letters, bytes) {
  const pixel = letters.length * bytes;
  const upper = is_bigendian ? 0 : bytes - 1;
  const places = [..."rgb"].map((one) => letters.indexOf(one) * bytes);
  const [red = 0, green = 0, blue = 0] = places.map((one) => one + upper);
  const value = (/** @type {number} */ at) =>
    bytes === 1 ? (data[at] ?? 0) : ((data[at + upper] ?? 0) << 8) | (data[at + 1 - upper] ?? 0);
  return {
    numbers: null,
    at: (x, y) => places.map((place) => value(y * row + x * pixel + place)),
    paint({ columns, rows }, packed) {
      const starts = columns.map((column) => column * pixel);
      rows.forEach((line, n) => {
        paintColors(packed, n * starts.length, data, line * row, starts, red, green, blue);
      });
    },
  };
}

/**
 * One row. What is done for each pixel has all that it needs as its own arguments: so it is three
 * times as fast.
 *
 * @param {Uint32Array} packed @param {number} to @param {Uint8Array} data @param {number} begin
 * @param {Int32Array} starts of pixels, from there on @param {number} red place in a pixel @param {number} green @param {number} blue
 */
function paintColors(packed, to, data, begin, starts, red, green, blue) {
  for (let n = 0; n < starts.length; n += 1) {
    const at = begin + (starts[n] ?? 0);
    packed[to + n] =
      OPAQUE |
      ((data[at + red] ?? 0) << RED) |
      ((data[at + green] ?? 0) << GREEN) |
      ((data[at + blue] ?? 0) << BLUE);
  }
}

/** @param {Rows} rows of one byte for each pixel @returns {Ink} */
export function greyInk({ raw: { data }, row }) {
  return {
    numbers: null,
    at: (x, y) => [data[y * row + x] ?? 0],
    paint({ columns, rows }, packed) {
      rows.forEach((line, n) => {
        paintGreys(packed, n * columns.length, data, line * row, columns);
      });
    },
  };
}

/** @param {Uint32Array} packed @param {number} to @param {Uint8Array} data @param {number} begin @param {Int32Array} columns */
function paintGreys(packed, to, data, begin, columns) {
  for (let n = 0; n < columns.length; n += 1)
    packed[to + n] = OPAQUE | ((data[begin + (columns[n] ?? 0)] ?? 0) * GREY);
}
