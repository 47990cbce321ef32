/** Raw images of cameras, whatever their encoding: the bytes of a message to what can be shown. */

import { mosaicPixels, pairPixels } from "./image-mosaics.js";

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

/**
 * @typedef {object} Picture
 * @property {number} width
 * @property {number} height
 * @property {Uint8ClampedArray<ArrayBuffer>} rgba
 * @property {boolean} isGrey every pixel is one number
 * @property {Float32Array<ArrayBuffer> | null} values where a pixel is a number that a byte does not hold
 * @property {Range} range
 * @property {string} unit of the values; empty: they have none
 */

const SIDE_MAX = 16_384;
const PIXELS_MAX = 1 << 26;
const NAME_MAX = 60;
const LITTLE = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

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

/** @typedef {{raw: RawImage, row: number}} Rows an image of which every row is there */

/** @param {RawImage} raw @param {number} pixel bytes of one @returns {Rows} */
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
const NUMBERS = /^(8|16|32|64)([USF])(?:C1)?$/;
const MOSAIC = /^bayer_(rggb|bggr|gbrg|grbg)(8|16)$/;
/** Where the first brightness is in the two bytes of a pixel. @type {Record<string, number>} */
const PAIRS = { yuv422: 1, uyvy: 1, yuv422_yuy2: 0, yuyv: 0 };
/** @type {Record<string, string>} by REP 118 */
const UNITS = { "16UC1": "mm", "32FC1": "m" };
/** @type {Record<string, string>} the numbers that they are */
const GREYS = { mono8: "8UC1", mono16: "16UC1" };

/**
 * @param {RawImage} raw
 * @param {Range | null} range of numbers; null: from the least to the largest
 * @returns {Picture}
 * @throws {ImageError}
 */
export function pictureOf(raw, range) {
  const { encoding } = raw;
  const numbers = NUMBERS.exec(GREYS[encoding] ?? encoding);
  if (numbers) return greyPicture(raw, Number(numbers[1]) / 8, numbers[2] ?? "U", range);
  const rgba = colorsOf(raw);
  return flatPicture(raw.width, raw.height, rgba, false);
}

/** @param {number} width @param {number} height @param {Uint8ClampedArray<ArrayBuffer>} rgba @param {boolean} isGrey @returns {Picture} of bytes that are shown as they are */
export function flatPicture(width, height, rgba, isGrey) {
  return { width, height, rgba, isGrey, values: null, range: { low: 0, high: 255 }, unit: "" };
}

/** @param {RawImage} raw @returns {Uint8ClampedArray<ArrayBuffer>} */
function colorsOf(raw) {
  const { encoding } = raw;
  const [, letters, bits] = COLORS.exec(encoding) ?? matrixOf(encoding);
  if (letters) return channelPixels(raw, letters, Number(bits) / 8);
  const [, pattern, depth] = MOSAIC.exec(encoding) ?? [];
  if (pattern) {
    const bytes = Number(depth) / 8;
    return mosaicPixels(rowsOf(raw, bytes), pattern, bytes, raw.is_bigendian ? 0 : bytes - 1);
  }
  const luma = Object.hasOwn(PAIRS, encoding) ? PAIRS[encoding] : undefined;
  if (luma !== undefined) return pairPixels(rowsOf(raw, 2), luma);
  throw new ImageError("image.trouble.encoding", { encoding: encoding.slice(0, NAME_MAX) });
}

/** @param {string} encoding as OpenCV names it: blue first @returns {string[]} as COLORS finds them */
function matrixOf(encoding) {
  const [, bits, channels] = MATRIX.exec(encoding) ?? [];
  return bits ? [encoding, channels === "4" ? "bgra" : "bgr", bits] : [];
}

/** @param {RawImage} raw @param {string} letters the order of the channels @param {number} bytes of each; of two the upper is shown */
function channelPixels(raw, letters, bytes) {
  const { width, height, data, is_bigendian } = raw;
  const pixel = letters.length * bytes;
  const { row } = rowsOf(raw, pixel);
  const upper = is_bigendian ? 0 : bytes - 1;
  const [red, green, blue] = ["r", "g", "b"].map((one) => letters.indexOf(one) * bytes + upper);
  const places = /** @type {[number, number, number]} */ ([red, green, blue]);
  const rgba = new Uint8ClampedArray(width * height * 4);
  const packed = new Uint32Array(rgba.buffer);
  for (let y = 0; y < height; y += 1)
    packRow(packed.subarray(y * width, (y + 1) * width), data, y * row, pixel, places);
  return rgba;
}

/** @param {Uint32Array} packed one row @param {Uint8Array} data @param {number} begin @param {number} pixel bytes of one @param {[number, number, number]} places of red, green and blue in it */
function packRow(packed, data, begin, pixel, [red, green, blue]) {
  let at = begin;
  for (let x = 0; x < packed.length; x += 1) {
    const r = data[at + red] ?? 0;
    const g = data[at + green] ?? 0;
    const b = data[at + blue] ?? 0;
    packed[x] = LITTLE
      ? 0xff000000 | (b << 16) | (g << 8) | r
      : (r << 24) | (g << 16) | (b << 8) | 0xff;
    at += pixel;
  }
}

/** @param {RawImage} raw @param {number} bytes of a number @param {string} kind U, S or F @param {Range | null} range @returns {Picture} */
function greyPicture(raw, bytes, kind, range) {
  const { width, height, encoding } = raw;
  const values = numbersOf(raw, bytes, kind);
  const isByte = bytes === 1 && kind === "U";
  // No depth was measured there: that is a zero in millimetres, and none of the numbers in metres.
  if (encoding === "16UC1") blank(values);
  const shown = isByte ? { low: 0, high: 255 } : (range ?? rangeOf(values));
  const rgba = shaded(values, shown);
  if (isByte) return flatPicture(width, height, rgba, true);
  const unit = UNITS[encoding] ?? "";
  return { width, height, rgba, isGrey: true, values, range: shown, unit };
}

/** @type {Record<string, (view: DataView, at: number, little: boolean) => number>} */
const READS = {
  U1: (view, at) => view.getUint8(at),
  S1: (view, at) => view.getInt8(at),
  U2: (view, at, little) => view.getUint16(at, little),
  S2: (view, at, little) => view.getInt16(at, little),
  S4: (view, at, little) => view.getInt32(at, little),
  F4: (view, at, little) => view.getFloat32(at, little),
  F8: (view, at, little) => view.getFloat64(at, little),
};

/** @param {RawImage} raw @param {number} bytes @param {string} kind @returns {Float32Array<ArrayBuffer>} row by row */
function numbersOf(raw, bytes, kind) {
  const { width, height, data, encoding } = raw;
  const read = READS[kind + bytes];
  if (!read) throw new ImageError("image.trouble.encoding", { encoding });
  const { row } = rowsOf(raw, bytes);
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const little = !raw.is_bigendian;
  const values = new Float32Array(width * height);
  for (let y = 0; y < height; y += 1)
    for (let x = 0; x < width; x += 1)
      values[y * width + x] = read(view, y * row + x * bytes, little);
  return values;
}

/** @param {Float32Array} values */
function blank(values) {
  for (let n = 0; n < values.length; n += 1) if (values[n] === 0) values[n] = Number.NaN;
}

/** @param {Float32Array} values @returns {Range} of those that are numbers */
export function rangeOf(values) {
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  for (let n = 0; n < values.length; n += 1) {
    const value = values[n] ?? Number.NaN;
    if (!Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? { low, high } : { low: 0, high: 1 };
}

/** @param {Float32Array} values @param {Range} range @returns {Uint8ClampedArray<ArrayBuffer>} nothing where there is no number */
function shaded(values, { low, high }) {
  const rgba = new Uint8ClampedArray(values.length * 4);
  const factor = high > low ? 255 / (high - low) : 0;
  for (let n = 0; n < values.length; n += 1) {
    const value = values[n] ?? Number.NaN;
    if (!Number.isFinite(value)) continue;
    const shade = (value - low) * factor;
    rgba[4 * n] = shade;
    rgba[4 * n + 1] = shade;
    rgba[4 * n + 2] = shade;
    rgba[4 * n + 3] = 255;
  }
  return rgba;
}

/** @param {Picture} picture @param {number} x @param {number} y @returns {number[]} what the pixel is: one number, or red, green and blue; none outside of the picture */
export function pixelAt({ width, height, rgba, values, isGrey }, x, y) {
  if (x < 0 || y < 0 || x >= width || y >= height) return [];
  const at = y * width + x;
  if (values) return [values[at] ?? Number.NaN];
  return Array.from(rgba.subarray(4 * at, 4 * at + (isGrey ? 1 : 3)));
}
