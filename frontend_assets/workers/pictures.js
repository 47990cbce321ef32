/** A topic of which images are looked at: of what comes, the newest is made to a picture. */

/** @import { Picture, Range, RawImage } from "../lib/image-pixels.js" */
/** @import { Came } from "./frames.js" */
/** @import { ToPage, Types, Wish } from "./wishes.js" */

import { sizeOfFile } from "../lib/image-file.js";
import { checkSize, flatPicture, ImageError, pictureOf } from "../lib/image-pixels.js";
import { readWith } from "./wishes.js";

/** @typedef {{key: string, words: Record<string, string | number>}} PictureTrouble a text of the catalogue, and what stands in it */
/** @typedef {{kind: "picture", wish: number, received_s: number, lost: number, bytes: number, encoding: string, picture: Picture | null, trouble: PictureTrouble | null}} Pictured */

const RAW = "sensor_msgs/msg/Image";
const COMPRESSED = "sensor_msgs/msg/CompressedImage";
const NAME_MAX = 60;

export class Pictures {
  /** @param {Wish} wish @param {Types} types @param {(message: ToPage) => void} post @param {Range | null} range of numbers, null: from the least to the largest */
  constructor(wish, types, post, range) {
    this.wish = wish;
    this.types = types;
    this.post = post;
    this.range = range;
    this.typeName = "";
    /** @type {Came | null} */
    this.last = null;
    this.isBusy = false;
    this.isStale = false;
  }

  /** @param {readonly Came[]} messages */
  take(messages) {
    this.last = messages.at(-1) ?? this.last;
    this.show();
  }

  /** @param {Range | null} range */
  shade(range) {
    this.range = range;
    this.show();
  }

  /** Files are unpacked one after the other; those that come meanwhile give way to the newest. */
  async show() {
    this.isStale = true;
    if (this.isBusy) return;
    this.isBusy = true;
    while (this.isStale) {
      this.isStale = false;
      await this.showNewest();
    }
    this.isBusy = false;
  }

  async showNewest() {
    const { last, typeName } = this;
    const type = typeName ? this.types.find(typeName) : null;
    if (!last || !type) return;
    const { value, trouble } = readWith(type, last.cdr);
    const made =
      value === undefined
        ? { picture: null, trouble: { key: "topics.unread", words: { reason: trouble } } }
        : await tried(typeName, value, this.range);
    this.post({
      kind: "picture",
      wish: this.wish.wish,
      received_s: last.received_s,
      lost: last.lost,
      bytes: last.cdr.length,
      encoding: `${value?.encoding ?? value?.format ?? ""}`.slice(0, NAME_MAX),
      ...made,
    });
  }
}

/** @param {string} typeName @param {any} value @param {Range | null} range @returns {Promise<{picture: Picture | null, trouble: PictureTrouble | null}>} */
async function tried(typeName, value, range) {
  try {
    return { picture: await made(typeName, value, range), trouble: null };
  } catch (error) {
    if (!(error instanceof ImageError)) throw error;
    return { picture: null, trouble: { key: error.key, words: error.words } };
  }
}

/** @param {string} typeName @param {any} value @param {Range | null} range @returns {Picture | Promise<Picture>} */
function made(typeName, value, range) {
  if (typeName === RAW && isRaw(value)) return pictureOf(value, range);
  const isFile = value.data instanceof Uint8Array && typeof value.format === "string";
  if (typeName === COMPRESSED && isFile) return unpacked(value);
  throw new ImageError("image.trouble.type", { type: typeName });
}

/** What a type is made of is told by others. @param {any} value @returns {value is RawImage} */
function isRaw(value) {
  const { width, height, step, encoding, is_bigendian, data } = value;
  const numbers = [width, height, step, is_bigendian];
  const areCounts = numbers.every((one) => Number.isInteger(one) && one >= 0);
  return areCounts && typeof encoding === "string" && data instanceof Uint8Array;
}

/** @param {{format: string, data: Uint8Array<ArrayBuffer>}} message @returns {Promise<Picture>} */
async function unpacked({ format, data }) {
  const name = format.slice(0, NAME_MAX);
  if (format.includes("compressedDepth"))
    throw new ImageError("image.trouble.depth", { format: name });
  const size = sizeOfFile(data);
  if (!size) throw new ImageError("image.trouble.file", { format: name });
  checkSize(size.width, size.height);
  const bitmap = await createImageBitmap(new Blob([data])).catch(() => null);
  if (!bitmap) throw new ImageError("image.trouble.broken", { format: name });
  return pixelsOf(bitmap);
}

/** @param {ImageBitmap} bitmap @returns {Picture} */
function pixelsOf(bitmap) {
  const { width, height } = bitmap;
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  context?.drawImage(bitmap, 0, 0);
  bitmap.close();
  const pixels = context?.getImageData(0, 0, width, height).data;
  if (!pixels) throw new ImageError("image.trouble.large", { width, height, side: 0 });
  return flatPicture(width, height, new Uint8ClampedArray(pixels.buffer), false);
}
