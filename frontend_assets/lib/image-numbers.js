/** Images whose pixels are numbers that a byte does not hold: depth, heat and the like. */

/** @import { Ink, Range, Rows } from "./image-pixels.js" */

import { GREY, IS_LITTLE, OPAQUE } from "./image-colors.js";

/** @typedef {Int8Array | Uint16Array | Int16Array | Int32Array | Float32Array | Float64Array} List */

/** @type {Record<string, new (buffer: ArrayBufferLike, at: number, length: number) => List>} */
const LISTS = {
  S1: Int8Array,
  U2: Uint16Array,
  S2: Int16Array,
  S4: Int32Array,
  F4: Float32Array,
  F8: Float64Array,
};
/** @type {Record<string, string>} by REP 118 */
const UNITS = { "16UC1": "mm", "32FC1": "m" };

/** @param {Rows} rows @param {string} kind S, U or F, and the bytes of a number @returns {Ink} */
export function numberInk(rows, kind) {
  const { encoding, width, height } = rows.raw;
  const { list, step } = listOf(rows, kind);
  // No depth was measured there: that is a zero in millimetres, and none of the numbers in metres.
  const none = encoding === "16UC1" ? 0 : Number.NaN;
  return {
    numbers: { range: rangeOf(list, width, height, step, none), unit: UNITS[encoding] ?? "" },
    at(x, y) {
      const value = list[y * step + x] ?? Number.NaN;
      return [value === none ? Number.NaN : value];
    },
    paint({ columns, rows: lines }, packed, range) {
      const factor = factorOf(range);
      lines.forEach((line, n) => {
        const to = n * columns.length;
        paintShades(packed, to, list, line * step, columns, none, range.low, factor);
      });
    },
  };
}

/** @param {Uint32Array} packed @param {number} to @param {List} list @param {number} begin @param {Int32Array} columns @param {number} none @param {number} low @param {number} factor */
function paintShades(packed, to, list, begin, columns, none, low, factor) {
  for (let n = 0; n < columns.length; n += 1) {
    const value = list[begin + (columns[n] ?? 0)] ?? none;
    packed[to + n] = value === none ? 0 : shadeOf((value - low) * factor);
  }
}

/** @param {Range} range @returns {number} shades to a number more */
const factorOf = ({ low, high }) => (high > low ? 255 / (high - low) : 0);

/** @param {number} value of which 0 is black and 255 white @returns {number} RGBA; nothing where there is no number */
function shadeOf(value) {
  if (value <= 0) return value > Number.NEGATIVE_INFINITY ? OPAQUE : 0;
  if (value >= 255) return value < Number.POSITIVE_INFINITY ? OPAQUE | (255 * GREY) : 0;
  // That leaves what lies between, and what is no number.
  return value > 0 ? OPAQUE | (((value + 0.5) | 0) * GREY) : 0;
}

/** @param {Rows} rows @param {string} kind @returns {{list: List, step: number}} a view of the bytes, where that is possible; `step`: numbers from row to row */
function listOf({ raw: { width, height, data, is_bigendian }, row }, kind) {
  const NumberList = /** @type {(typeof LISTS)[string]} */ (LISTS[kind]);
  const size = Number(kind[1]);
  const isForeign = Boolean(is_bigendian) === IS_LITTLE;
  if (size === 1 || (!isForeign && row % size === 0 && data.byteOffset % size === 0)) {
    const count = Math.floor(data.length / size);
    return { list: new NumberList(data.buffer, data.byteOffset, count), step: row / size };
  }
  const own = new Uint8Array(width * height * size);
  for (let y = 0; y < height; y += 1)
    own.set(data.subarray(y * row, y * row + width * size), y * width * size);
  if (isForeign) turn(own, size);
  return { list: new NumberList(own.buffer, 0, width * height), step: width };
}

/** Turn the order of the bytes of each number. @param {Uint8Array} bytes @param {number} size */
function turn(bytes, size) {
  for (let at = 0; at < bytes.length; at += size)
    for (let n = 0; n < size >> 1; n += 1) {
      const first = bytes[at + n] ?? 0;
      bytes[at + n] = bytes[at + size - 1 - n] ?? 0;
      bytes[at + size - 1 - n] = first;
    }
}

/** @param {List} list @param {number} width @param {number} height @param {number} step @param {number} none what stands where nothing was measured @returns {Range} of those that are numbers */
function rangeOf(list, width, height, step, none) {
  const range = { low: Number.POSITIVE_INFINITY, high: Number.NEGATIVE_INFINITY };
  for (let y = 0; y < height; y += 1) widen(range, list, y * step, y * step + width, none);
  return range.low <= range.high ? range : { low: 0, high: 1 };
}

/** Widen a range by what one row measures. @param {Range} range @param {List} list @param {number} begin @param {number} end @param {number} none */
function widen(range, list, begin, end, none) {
  let { low, high } = range;
  for (let at = begin; at < end; at += 1) {
    const value = list[at] ?? none;
    if (value === none) continue;
    if (value < low && value > Number.NEGATIVE_INFINITY) low = value;
    if (value > high && value < Number.POSITIVE_INFINITY) high = value;
  }
  Object.assign(range, { low, high });
}
