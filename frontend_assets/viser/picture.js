/** @import { Door } from "./door.js" */
/** @import { Renderer } from "./viser.d.ts" */

import { BACKGROUND } from "./theme.js";

/** The 3D view as a PNG, as large as is wished, on its background or on none. */
export class Picture {
  #door;
  /** @type {Renderer | null} */
  #renderer = null;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onPicture((renderer) => {
      this.#renderer = renderer;
    });
  }

  /**
   * @param {number} scale pixels of the picture for one of the page
   * @param {boolean} transparent
   * @returns {Promise<Blob | null>} null: this browser cannot draw so large a picture
   */
  async take(scale, transparent) {
    const { canvas, scene, camera } = this.#door.mutable ?? {};
    const renderer = this.#renderer;
    if (!canvas || !scene || !camera || !renderer) return null;
    const usual = renderer.getPixelRatio();
    const [width, height] = [canvas.clientWidth * scale, canvas.clientHeight * scale];
    try {
      renderer.setPixelRatio(scale);
      renderer.render(scene, camera);
      if (canvas.width < Math.floor(width) || canvas.height < Math.floor(height)) return null;
      return await painted(canvas, transparent);
    } finally {
      renderer.setPixelRatio(usual);
      this.#door.redraw();
    }
  }
}

/** @param {HTMLCanvasElement} drawn @param {boolean} transparent @returns {Promise<Blob | null>} */
function painted(drawn, transparent) {
  const canvas = document.createElement("canvas");
  canvas.width = drawn.width;
  canvas.height = drawn.height;
  const paint = canvas.getContext("2d");
  if (!paint) return Promise.resolve(null);
  if (!transparent) {
    paint.fillStyle = background(paint, canvas.width, canvas.height);
    paint.fillRect(0, 0, canvas.width, canvas.height);
  }
  paint.drawImage(drawn, 0, 0);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

/** As the style sheet paints it behind the view. @param {CanvasRenderingContext2D} paint @param {number} width @param {number} height */
function background(paint, width, height) {
  const style = getComputedStyle(document.documentElement);
  const [x, y] = [width * 0.5, height * 0.3];
  const gradient = paint.createRadialGradient(x, y, 0, x, y, Math.max(width * 1.2, height * 0.95));
  BACKGROUND.forEach((name, at) => {
    const colour = style.getPropertyValue(name).trim() || "#000";
    gradient.addColorStop([0, 0.48, 1][at] ?? 1, colour);
  });
  return gradient;
}
