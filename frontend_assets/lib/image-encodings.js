/**
 * Raw images of cameras, whatever their encoding: the bytes of a message to what can be shown.
 * Pixels have a colour each (RGB, grey), share colours (YUV 4:2:2, Bayer), or are numbers that a
 * byte does not hold (depth, heat).
 */

/** @import { Window } from "./image-view.js" */

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

/** Whether the first byte of a number is its least, on this machine. */
const IS_LITTLE = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;
/** How far to the left each of them stands in the four bytes of a pixel, taken as one number. */
export const [RED, GREEN, BLUE, ALPHA] = IS_LITTLE ? [0, 8, 16, 24] : [24, 16, 8, 0];
const OPAQUE = 255 << /** @type {number} */ (ALPHA);
/** A grey of one, to be multiplied. */
export const GREY = (1 << /** @type {number} */ (RED)) | (1 << GREEN) | (1 << BLUE);

/** @param {Rows} rows @param {string} letters the order of the channels @param {number} bytes of each; of two the upper is shown @returns {Ink} */
function channelInk({ raw: { data, is_bigendian }, row }, letters, bytes) {
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
function greyInk({ raw: { data }, row }) {
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
function pairInk({ raw: { width, data }, row }, luma) {
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
function mosaicInk({ raw: { width, height, data, is_bigendian }, row }, pattern, bytes) {
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
function numberInk(rows, kind) {
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
