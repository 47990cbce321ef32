/** Images as a camera sends them, and what they show by a reader that is slow and plain. */

/** @import { RawImage } from "../../../frontend_assets/lib/image-encodings.js" */

/** @param {string} encoding @param {number} width @param {number} height @param {ArrayLike<number>} bytes @param {{step?: number, is_bigendian?: number}} [more] @returns {RawImage} */
export const raw = (encoding, width, height, bytes, { step = 0, is_bigendian = 0 } = {}) => ({
  encoding,
  width,
  height,
  step,
  is_bigendian,
  data: Uint8Array.from(bytes),
});

/** How a PNG of 640 x 480 begins. */
export const PNG = [
  0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 2, 128, 0, 0, 1, 224,
];

/**
 * @param {Omit<RawImage, "data">} head its last row ends with its pixels
 * @param {number} begin where its bytes begin in their buffer
 * @returns {RawImage} of any bytes, the same each time; among them zeros
 */
export function noisy(head, begin) {
  const bytes = new Uint8Array(begin + head.step * head.height);
  let state = 9 + head.width + 31 * head.height + 7 * head.step;
  for (let n = 0; n < bytes.length; n += 1) {
    state = (Math.imul(state, 1_103_515_245) + 12_345) & 0x7f_ff_ff_ff;
    bytes[n] = state >> 16;
  }
  bytes.fill(0, begin, begin + (head.width > 2 ? 8 : 0));
  return { ...head, data: bytes.subarray(begin) };
}

/** @typedef {{rgba: number[], values: number[], isExact: boolean}} SlowPixel `values` as a person is told them */

/** @param {RawImage} image @param {number} x @param {number} y @param {{low: number, high: number}} range @returns {SlowPixel} */
export function slowPixel(image, x, y, range) {
  const { encoding } = image;
  if (/yu/.test(encoding) || encoding === "uyvy") return slowPair(image, x, y);
  if (encoding.startsWith("bayer_")) return slowSquare(image, x, y);
  if (/rgb|bgr|UC[34]/.test(encoding)) return slowColor(image, x, y);
  return slowNumber(image, x, y, range);
}

/** @param {RawImage} image @param {number} at @param {number} bytes @returns {number} */
function unsigned({ data, is_bigendian }, at, bytes) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  return bytes === 1 ? view.getUint8(at) : view.getUint16(at, !is_bigendian);
}

/** @param {RawImage} image @param {number} x @param {number} y @returns {SlowPixel} */
function slowColor(image, x, y) {
  const { encoding, step } = image;
  const bytes = encoding.includes("16") ? 2 : 1;
  const named = /[rgba]{3,4}/.exec(encoding)?.[0];
  const letters = named ?? (encoding.endsWith("4") ? "bgra" : "bgr");
  const values = [..."rgb"].map((letter) =>
    unsigned(image, y * step + (x * letters.length + letters.indexOf(letter)) * bytes, bytes),
  );
  const rgb = values.map((one) => (bytes === 2 ? one >> 8 : one));
  return { rgba: [...rgb, 255], values, isExact: true };
}

/** @type {Record<string, (view: DataView, at: number, little: boolean) => number>} */
const READS = {
  "8U": (view, at) => view.getUint8(at),
  "8S": (view, at) => view.getInt8(at),
  "16U": (view, at, little) => view.getUint16(at, little),
  "16S": (view, at, little) => view.getInt16(at, little),
  "32S": (view, at, little) => view.getInt32(at, little),
  "32F": (view, at, little) => view.getFloat32(at, little),
  "64F": (view, at, little) => view.getFloat64(at, little),
};

/** @param {RawImage} image @param {number} x @param {number} y @param {{low: number, high: number}} range @returns {SlowPixel} */
function slowNumber({ encoding, step, data, is_bigendian }, x, y, { low, high }) {
  const kind = encoding.replace("mono8", "8U").replace("mono16", "16U").replace("C1", "");
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const at = y * step + (x * Number.parseInt(kind, 10)) / 8;
  const value = READS[kind]?.(view, at, !is_bigendian) ?? Number.NaN;
  const isNone = !Number.isFinite(value) || (encoding === "16UC1" && value === 0);
  const part = kind === "8U" ? value / 255 : (value - low) / (high - low);
  const shade = 255 * Math.max(0, Math.min(1, part));
  const told = encoding === "16UC1" && isNone ? Number.NaN : value;
  const rgba = isNone ? [0, 0, 0, 0] : [shade, shade, shade, 255];
  return { rgba, values: [told], isExact: true };
}

/** @param {RawImage} image @param {number} x @param {number} y @returns {SlowPixel} */
function slowPair({ encoding, width, step, data }, x, y) {
  const row = data.subarray(y * step, y * step + 2 * width);
  const isLumaFirst = encoding.startsWith("yuyv") || encoding.endsWith("yuy2");
  // In a row that ends amid a pair, the last pixel takes the colour of the pair before.
  const pair = x % 2 === 0 && x + 1 === width ? Math.max(0, x - 2) : x - (x % 2);
  const [luma, u] = isLumaFirst ? [2 * x, 2 * pair + 1] : [2 * x + 1, 2 * pair];
  const [Y, U, V] = [row[luma] ?? 0, (row[u] ?? 128) - 128, (row[u + 2] ?? 128) - 128];
  const rgb = [Y + 1.402 * V, Y - 0.344136 * U - 0.714136 * V, Y + 1.772 * U];
  const values = rgb.map((one) => Math.max(0, Math.min(255, one)));
  return { rgba: [...values, 255], values, isExact: false };
}

/** @param {RawImage} image @param {number} x @param {number} y @returns {SlowPixel} */
function slowSquare(image, x, y) {
  const { encoding, width, height, step } = image;
  const bytes = encoding.endsWith("16") ? 2 : 1;
  const pattern = encoding.slice("bayer_".length);
  const begin = (/** @type {number} */ at, /** @type {number} */ length) =>
    at + 1 === length && length % 2 === 1 ? Math.max(0, at - 2 + (at % 2)) : at - (at % 2);
  /** @type {Record<string, number[]>} */
  const found = { r: [], g: [], b: [] };
  for (const [n, letter] of [...pattern.slice(0, 4)].entries()) {
    const column = Math.min(begin(x, width) + (n % 2), width - 1);
    const line = Math.min(begin(y, height) + (n >> 1), height - 1);
    found[letter]?.push(unsigned(image, line * step + column * bytes, bytes) >> (8 * (bytes - 1)));
  }
  const values = Object.values(found).map(
    (all) => all.reduce((sum, one) => sum + one) / all.length,
  );
  return { rgba: [...values, 255], values, isExact: false };
}
