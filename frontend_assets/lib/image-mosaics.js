/** Images in which pixels share their colours: pairs of YUV 4:2:2, and squares of a Bayer sensor. */

/** @import { Rows } from "./image-pixels.js" */

/**
 * Full range BT.601, as cameras send it over USB.
 *
 * @param {Rows} rows of two bytes for each pixel
 * @param {number} luma where the brightness is in them
 * @returns {Uint8ClampedArray<ArrayBuffer>} RGBA
 */
export function pairPixels({ raw: { width, height, data }, row }, luma) {
  const rgba = new Uint8ClampedArray(width * height * 4).fill(255);
  const last = Math.max(0, (width & ~1) - 2);
  for (let y = 0; y < height; y += 1)
    for (let x = 0; x < width; x += 1) {
      // A row of odd width ends amid a pair: its last pixel has the colour of the pair before.
      const pair = y * row + 2 * Math.min(x & ~1, last) + 1 - luma;
      const brightness = data[y * row + 2 * x + luma] ?? 0;
      const u = (data[pair] ?? 128) - 128;
      const v = (data[pair + 2] ?? 128) - 128;
      const at = 4 * (y * width + x);
      rgba[at] = brightness + 1.402 * v;
      rgba[at + 1] = brightness - 0.344136 * u - 0.714136 * v;
      rgba[at + 2] = brightness + 1.772 * u;
    }
  return rgba;
}

/**
 * Every square of 2 x 2 pixels gets the colour that its four measure: nothing is guessed.
 *
 * @param {Rows} rows
 * @param {string} pattern the colours of a square, row by row
 * @param {number} bytes of a pixel
 * @param {number} upper which of them is shown
 * @returns {Uint8ClampedArray<ArrayBuffer>} RGBA
 */
export function mosaicPixels({ raw: { width, height, data }, row }, pattern, bytes, upper) {
  const rgba = new Uint8ClampedArray(width * height * 4).fill(255);
  const [red, blue] = [pattern.indexOf("r"), pattern.indexOf("b")];
  const square = new Uint8Array(4);
  for (let y = 0; y < height; y += 1)
    for (let x = 0; x < width; x += 1) {
      const left = startOf(x, width);
      const top = startOf(y, height);
      for (let n = 0; n < 4; n += 1) {
        const column = Math.min(left + (n & 1), width - 1);
        const line = Math.min(top + (n >> 1), height - 1);
        square[n] = data[line * row + column * bytes + upper] ?? 0;
      }
      const r = square[red] ?? 0;
      const b = square[blue] ?? 0;
      const at = 4 * (y * width + x);
      rgba[at] = r;
      rgba[at + 1] = (sumOf(square) - r - b) >> 1;
      rgba[at + 2] = b;
    }
  return rgba;
}

/** @param {number} at @param {number} length @returns {number} where its square begins: a whole one, where there is any */
const startOf = (at, length) => Math.min(at & ~1, Math.max(0, (length & ~1) - 2));

/** @param {Uint8Array} square @returns {number} */
function sumOf(square) {
  let sum = 0;
  for (let n = 0; n < square.length; n += 1) sum += square[n] ?? 0;
  return sum;
}
