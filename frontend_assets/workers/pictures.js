/**
 * A topic of which images are looked at: of what comes, the newest is painted, once for each frame
 * that the screen shows. What came between is passed over; nothing queues.
 */

/** @import { Ink, Numbers, Range, RawImage } from "../lib/image-encodings.js" */
/** @import { Sight, Window } from "../lib/image-view.js" */
/** @import { Came } from "./frames.js" */
/** @import { ToPage, Types, SubscribeCommand } from "./subscriptions.js" */
/** @import { View } from "../lib/pan-zoom.js" */

import { checkSize, ImageError, inkOf } from "../lib/image-encodings.js";
import { average, rateOf, viewWithin, wholeOf, windowOf } from "../lib/image-view.js";
import { readWith } from "./subscriptions.js";

/** @typedef {{key: string, words: Record<string, string | number>}} PictureTrouble a text of the catalogue, and what stands in it */
/** @typedef {{x: number, y: number}} Pixel column and row */

/**
 * @typedef {object} Pictured what is said of the picture that is shown
 * @property {"picture"} kind
 * @property {number} subscription
 * @property {number} painted how many were, since it is looked at
 * @property {number | null} rate_hz of those; null: that cannot be told yet
 * @property {number} bytes of the message
 * @property {string} encoding
 * @property {{width: number, height: number} | null} size null: there is no picture
 * @property {Numbers | null} numbers null: its pixels are colours
 * @property {(Pixel & {values: number[]}) | null} pointed the pixel that was pointed at
 * @property {PictureTrouble | null} trouble
 */

/** @typedef {{kind: "saved", subscription: number, file: Blob}} SavedPicture as PNG */
/** @typedef {Pictured | SavedPicture} PictureToPage */

/**
 * @typedef {{kind: "sight", sight: Sight}} AskSight
 * @typedef {{kind: "shade", range: Range | null}} AskShade null: from the least number to the largest
 * @typedef {{kind: "point", pixel: Pixel | null}} AskPoint
 * @typedef {{kind: "save"}} AskSave
 * @typedef {AskSight | AskShade | AskPoint | AskSave} PictureAsked
 */

const RAW = "sensor_msgs/msg/Image";
const COMPRESSED = "sensor_msgs/msg/CompressedImage";
const NAME_MAX = 60;
const TIMES_MAX = 30;
/** What is said of pictures is read by people. */
const SAY_EVERY_MS = 150;
const FROM_BYTES = { low: 0, high: 255 };

/** @typedef {{bytes: number, encoding: string, motif: Motif | null, trouble: PictureTrouble | null}} Read what became of a message */

export class Pictures {
  /**
   * @param {SubscribeCommand} command @param {Types} types @param {(message: PictureToPage | ToPage) => void} post @param {Easel} easel
   * @param {(paint: () => void) => void} nextFrame calls when the screen is ready for another one
   */
  constructor(command, types, post, easel, nextFrame) {
    this.command = command;
    this.types = types;
    this.post = post;
    this.easel = easel;
    this.nextFrame = nextFrame;
    this.typeName = "";
    /** @type {Sight} */
    this.sight = { width: 0, height: 0, ratio: 1, view: null };
    /** @type {Range | null} */
    this.range = null;
    /** @type {Pixel | null} */
    this.pixel = null;
    /** The newest that came, until it is read. @type {Came | null} */
    this.waiting = null;
    /** @type {Read | null} */
    this.shown = null;
    /** What that was made of. @type {Came | null} */
    this.source = null;
    this.painted = 0;
    /** @type {number[]} */
    this.times_s = [];
    this.isAsked = false;
    this.said_ms = Number.NEGATIVE_INFINITY;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.saying = undefined;
  }

  /** @param {readonly Came[]} messages */
  take(messages) {
    for (const came of messages) {
      this.waiting?.done?.();
      this.waiting = came;
    }
    this.show();
  }

  /** Paint with the next frame. */
  show() {
    if (this.isAsked) return;
    this.isAsked = true;
    this.nextFrame(() => this.step());
  }

  /** @param {PictureAsked} asked */
  carryOut(asked) {
    if (asked.kind === "save") this.save();
    else if (asked.kind === "point") {
      this.pixel = asked.pixel;
      this.say();
    } else {
      if (asked.kind === "sight") this.sight = asked.sight;
      else this.range = asked.range;
      this.show();
    }
  }

  leave() {
    clearTimeout(this.saying);
    this.shown?.motif?.bitmap?.close();
    this.shown = null;
  }

  async step() {
    const type = this.typeName ? this.types.find(this.typeName) : null;
    try {
      if (type) await this.read(type);
      this.paint();
    } finally {
      this.isAsked = false;
    }
    // More came while a file was unpacked.
    if (type && this.waiting) this.show();
  }

  /** @param {{read: ((cdr: Uint8Array) => any) | null, trouble: string}} type */
  async read(type) {
    const came = this.waiting;
    this.waiting = null;
    if (!came) return;
    const read = await readImage(this.typeName, readWith(type, came.cdr), came.cdr.length);
    this.change(read, came);
  }

  /** @param {Read} read @param {Came} came */
  change(read, came) {
    const before = this.shown;
    before?.motif?.bitmap?.close();
    this.source?.done?.();
    this.shown = read;
    this.source = came;
    if (read.motif) {
      this.painted += 1;
      this.times_s = [...this.times_s.slice(1 - TIMES_MAX), came.received_s];
    }
    if (areAlike(before, read)) this.sayLater();
    else this.say();
  }

  paint() {
    const motif = this.shown?.motif;
    if (motif) this.easel.paint(motif, this.sight, this.rangeOf(motif));
  }

  /** @param {Motif} motif @returns {Range} from black to white */
  rangeOf({ ink }) {
    return this.range ?? ink?.numbers?.range ?? FROM_BYTES;
  }

  async save() {
    const motif = this.shown?.motif;
    if (!motif) return;
    const file = await fileOf(motif, this.rangeOf(motif));
    this.post({ kind: "saved", subscription: this.command.subscription, file });
  }

  sayLater() {
    const wait_ms = this.said_ms + SAY_EVERY_MS - performance.now();
    if (wait_ms <= 0) this.say();
    else this.saying ??= setTimeout(() => this.say(), wait_ms);
  }

  say() {
    clearTimeout(this.saying);
    this.saying = undefined;
    const read = this.shown;
    if (!read) return;
    this.said_ms = performance.now();
    const { motif, bytes, encoding, trouble } = read;
    this.post({
      kind: "picture",
      subscription: this.command.subscription,
      painted: this.painted,
      rate_hz: rateOf(this.times_s),
      bytes,
      encoding,
      size: motif && { width: motif.width, height: motif.height },
      numbers: motif?.ink?.numbers ?? null,
      pointed: motif && this.pixel && pointedOf(motif, this.pixel),
      trouble,
    });
  }
}

/** @param {Read | null} before @param {Read} read @returns {boolean} whether what is said of them is the same, but for numbers */
function areAlike(before, read) {
  return (
    before?.encoding === read.encoding &&
    before.trouble?.key === read.trouble?.key &&
    before.motif?.width === read.motif?.width &&
    before.motif?.height === read.motif?.height
  );
}

/** @param {Motif} motif @param {Pixel} pixel @returns {(Pixel & {values: number[]}) | null} null: it is outside of the picture */
function pointedOf({ width, height, ink, bitmap }, { x, y }) {
  if (x < 0 || y < 0 || x >= width || y >= height) return null;
  const values = ink?.at(x, y) ?? (bitmap ? pixelOf(bitmap, x, y) : []);
  return { x, y, values };
}

/** @param {string} typeName @param {{value: any, trouble: string}} found @param {number} bytes @returns {Promise<Read>} */
async function readImage(typeName, { value, trouble }, bytes) {
  if (value === undefined) {
    const unread = { key: "topics.unread", words: { reason: trouble } };
    return { bytes, encoding: "", motif: null, trouble: unread };
  }
  const encoding = `${value.encoding ?? value.format ?? ""}`.slice(0, NAME_MAX);
  try {
    return { bytes, encoding, motif: await motifOf(typeName, value), trouble: null };
  } catch (error) {
    if (!(error instanceof ImageError)) throw error;
    return { bytes, encoding, motif: null, trouble: { key: error.key, words: error.words } };
  }
}

/** @param {string} typeName @param {any} value @returns {Promise<Motif>} @throws {ImageError} */
async function motifOf(typeName, value) {
  if (typeName === RAW && isRaw(value)) {
    const { width, height } = value;
    checkSize(width, height);
    return { width, height, ink: inkOf(value), bitmap: null };
  }
  const isFile = value.data instanceof Uint8Array && typeof value.format === "string";
  if (typeName !== COMPRESSED || !isFile)
    throw new ImageError("image.trouble.type", { type: typeName });
  const bitmap = await unpacked(value);
  return { width: bitmap.width, height: bitmap.height, ink: null, bitmap };
}

/** What a type is made of is told by others. @param {any} value @returns {value is RawImage} */
function isRaw(value) {
  const { width, height, step, encoding, is_bigendian, data } = value;
  const numbers = [width, height, step, is_bigendian];
  const areCounts = numbers.every((one) => Number.isInteger(one) && one >= 0);
  return areCounts && typeof encoding === "string" && data instanceof Uint8Array;
}

/** @typedef {{width: number, height: number, ink: Ink | null, bitmap: ImageBitmap | null}} Motif what is painted: one of the two has its pixels */

/** @typedef {OffscreenCanvasRenderingContext2D} Context */

/** A pixel of the screen covers four of the picture, or more. */
const SMOOTH_BELOW = 0.5;

/** Where a picture is painted: a canvas of the page that was given to the worker. */
export class Easel {
  /** @param {OffscreenCanvas} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    // What is painted comes from the processor: there it is kept.
    this.context = canvas.getContext("2d", { willReadFrequently: true });
    /** Both are used again and again. @type {ImageData | null} */
    this.image = null;
    this.fine = new Uint32Array(0);
  }

  /** @param {Sight} sight */
  fit({ width, height }) {
    const { canvas } = this;
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
  }

  /** @param {Motif} motif @param {Sight} sight @param {Range} range */
  paint(motif, sight, range) {
    this.fit(sight);
    const { context } = this;
    if (!context) return;
    context.clearRect(0, 0, sight.width, sight.height);
    const view = viewWithin(motif, sight);
    if (motif.ink) this.paintView(context, motif, motif.ink, view, range);
    else if (motif.bitmap) drawBitmap(context, motif.bitmap, view);
  }

  /** @param {Context} context @param {Motif} motif @param {Ink} ink @param {View} view @param {Range} range */
  paintView(context, motif, ink, view, range) {
    // Between two depths is none that was measured.
    const parts = view.scale <= SMOOTH_BELOW && !ink.numbers ? 2 : 1;
    this.paintInk(context, ink, windowOf(motif, view, this.canvas, parts), range, parts);
  }

  /** @param {Context} context @param {Ink} ink @param {Window} window @param {Range} range @param {number} parts of the window for each pixel, across and down */
  paintInk(context, ink, window, range, parts) {
    const [width, height] = [window.columns.length / parts, window.rows.length / parts];
    if (width === 0 || height === 0) return;
    const image = this.imageOf(width, height);
    const packed = new Uint32Array(image.data.buffer);
    if (parts === 1) ink.paint(window, packed, range);
    else {
      const fine = this.fineOf(4 * packed.length);
      ink.paint(window, fine, range);
      average(fine, packed, width);
    }
    context.putImageData(image, window.left, window.top);
  }

  /** @param {number} width @param {number} height @returns {ImageData} */
  imageOf(width, height) {
    const before = this.image;
    if (before?.width === width && before.height === height) return before;
    this.image = new ImageData(width, height);
    return this.image;
  }

  /** @param {number} length @returns {Uint32Array} */
  fineOf(length) {
    if (this.fine.length !== length) this.fine = new Uint32Array(length);
    return this.fine;
  }
}

/** @param {Context} context @param {ImageBitmap} bitmap @param {View} view */
function drawBitmap(context, bitmap, { x, y, scale }) {
  context.imageSmoothingEnabled = scale <= SMOOTH_BELOW;
  context.drawImage(bitmap, x, y, bitmap.width * scale, bitmap.height * scale);
}

/** @param {Motif} motif @param {Range} range @returns {Promise<Blob>} all of it, as PNG */
function fileOf(motif, range) {
  const { width, height, ink, bitmap } = motif;
  const canvas = new OffscreenCanvas(width, height);
  const easel = new Easel(canvas);
  if (easel.context && ink) easel.paintInk(easel.context, ink, wholeOf(motif), range, 1);
  else if (bitmap) easel.context?.drawImage(bitmap, 0, 0);
  return canvas.convertToBlob({ type: "image/png" });
}

const FORMAT_NAME_MAX = 60;

/** @param {{format: string, data: Uint8Array<ArrayBuffer>}} message @returns {Promise<ImageBitmap>} @throws {ImageError} */
export async function unpacked({ format, data }) {
  const name = format.slice(0, FORMAT_NAME_MAX);
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
function pixelOf(bitmap, x, y) {
  const context = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  context?.drawImage(bitmap, x, y, 1, 1, 0, 0, 1, 1);
  return Array.from(context?.getImageData(0, 0, 1, 1).data.subarray(0, 3) ?? []);
}

const PNG = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
/** Behind these marks of a JPEG is its size; the others of that row are tables. */
const isFrame = (/** @type {number} */ mark) =>
  mark >= 0xc0 && mark <= 0xcf && ![0xc4, 0xc8, 0xcc].includes(mark);

/** @param {Uint8Array} bytes @returns {{width: number, height: number} | null} null: it is neither */
export function sizeOfFile(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length >= 24 && PNG.every((one, n) => bytes[n] === one))
    return { width: view.getUint32(16), height: view.getUint32(20) };
  return bytes[0] === 0xff && bytes[1] === 0xd8 ? sizeOfJpeg(view) : null;
}

/** @param {DataView} view @returns {{width: number, height: number} | null} */
function sizeOfJpeg(view) {
  let at = 2;
  while (at + 9 <= view.byteLength && view.getUint8(at) === 0xff) {
    const mark = view.getUint8(at + 1);
    if (isFrame(mark)) return { height: view.getUint16(at + 5), width: view.getUint16(at + 7) };
    // Marks may be filled up with more of the sign that they begin with.
    at += mark === 0xff ? 1 : 2 + view.getUint16(at + 2);
  }
  return null;
}
