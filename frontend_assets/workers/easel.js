/** Where a picture is painted: a canvas of the page that was given to the worker. */

/** @import { Ink, Range } from "../lib/image-pixels.js" */
/** @import { Sight, Window } from "../lib/image-window.js" */
/** @import { View } from "../lib/pan-zoom.js" */

import { average } from "../lib/image-smoothing.js";
import { viewWithin, wholeOf, windowOf } from "../lib/image-window.js";

/** @typedef {{width: number, height: number, ink: Ink | null, bitmap: ImageBitmap | null}} Motif what is painted: one of the two has its pixels */

/** @typedef {OffscreenCanvasRenderingContext2D} Context */

/** A pixel of the screen covers four of the picture, or more. */
const SMOOTH_BELOW = 0.5;

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
export function fileOf(motif, range) {
  const { width, height, ink, bitmap } = motif;
  const canvas = new OffscreenCanvas(width, height);
  const easel = new Easel(canvas);
  if (easel.context && ink) easel.paintInk(easel.context, ink, wholeOf(motif), range, 1);
  else if (bitmap) easel.context?.drawImage(bitmap, 0, 0);
  return canvas.convertToBlob({ type: "image/png" });
}
