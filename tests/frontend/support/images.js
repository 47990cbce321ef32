/** Images as a camera sends them, and what they show by a reader that is slow and plain. */

/** @import { RawImage } from "../../../frontend_assets/lib/image-pixels.js" */

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
