/** Images that came as a file, JPEG or PNG: unpacked by the browser. */

import { sizeOfFile } from "../lib/image-file.js";
import { checkSize, ImageError } from "../lib/image-pixels.js";

const NAME_MAX = 60;

/** @param {{format: string, data: Uint8Array<ArrayBuffer>}} message @returns {Promise<ImageBitmap>} @throws {ImageError} */
export async function unpacked({ format, data }) {
  const name = format.slice(0, NAME_MAX);
  if (format.includes("compressedDepth"))
    throw new ImageError("image.trouble.depth", { format: name });
  const size = sizeOfFile(data);
  if (!size) throw new ImageError("image.trouble.file", { format: name });
  checkSize(size.width, size.height);
  const bitmap = await createImageBitmap(new Blob([data])).catch(() => null);
  if (!bitmap) throw new ImageError("image.trouble.broken", { format: name });
  return bitmap;
}

/** @param {ImageBitmap} bitmap @param {number} x @param {number} y @returns {number[]} red, green and blue */
export function pixelOf(bitmap, x, y) {
  const context = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  context?.drawImage(bitmap, x, y, 1, 1, 0, 0, 1, 1);
  return Array.from(context?.getImageData(0, 0, 1, 1).data.subarray(0, 3) ?? []);
}
