/** Where a picture is painted: a canvas of the page that was given to the worker. */

/** @import { Ink, Range } from "../lib/image-pixels.js" */
/** @import { Sight, Window } from "../lib/image-window.js" */

import { filling } from "../lib/image-view.js";
import { wholeOf, windowOf } from "../lib/image-window.js";

/** @typedef {{width: number, height: number, ink: Ink | null, bitmap: ImageBitmap | null}} Motif what is painted: one of the two has its pixels */

/** @typedef {OffscreenCanvasRenderingContext2D} Context */

export class Easel {
  /** @param {OffscreenCanvas} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    // What is painted comes from the processor: there it is kept.
    this.context = canvas.getContext("2d", { willReadFrequently: true });
    /** Used again and again. @type {ImageData | null} */
    this.image = null;
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
    if (motif.ink) this.paintInk(context, motif.ink, windowOf(motif, sight), range);
    else if (motif.bitmap) drawBitmap(context, motif.bitmap, sight);
  }

  /** @param {Context} context @param {Ink} ink @param {Window} window @param {Range} range */
  paintInk(context, ink, window, range) {
    const { left, top, columns, rows } = window;
    if (columns.length === 0 || rows.length === 0) return;
    const image = this.imageOf(columns.length, rows.length);
    ink.paint(window, new Uint32Array(image.data.buffer), range);
    context.putImageData(image, left, top);
  }

  /** @param {number} width @param {number} height @returns {ImageData} */
  imageOf(width, height) {
    const before = this.image;
    if (before?.width === width && before.height === height) return before;
    this.image = new ImageData(width, height);
    return this.image;
  }
}

/** @param {Context} context @param {ImageBitmap} bitmap @param {Sight} sight */
function drawBitmap(context, bitmap, { width, height, ratio, view }) {
  const { x, y, scale } = view ?? filling(bitmap, { width: width / ratio, height: height / ratio });
  const zoom = scale * ratio;
  context.imageSmoothingEnabled = zoom < 1;
  context.drawImage(bitmap, x * ratio, y * ratio, bitmap.width * zoom, bitmap.height * zoom);
}

/** @param {Motif} motif @param {Range} range @returns {Promise<Blob>} all of it, as PNG */
export function fileOf(motif, range) {
  const { width, height, ink, bitmap } = motif;
  const canvas = new OffscreenCanvas(width, height);
  const easel = new Easel(canvas);
  if (easel.context && ink) easel.paintInk(easel.context, ink, wholeOf(motif), range);
  else if (bitmap) easel.context?.drawImage(bitmap, 0, 0);
  return canvas.convertToBlob({ type: "image/png" });
}
