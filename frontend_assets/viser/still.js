/** @import { Door } from "./door.js" */
/** @import { Renderer } from "./viser.d.ts" */
import { isLight } from "./quality.js";

const REST_MS = 350;
const FINER = 2;

/**
 * Drawn lightly, a moving picture has one sample a pixel; the picture that comes to rest
 * is drawn once more with four. Not when the address fixed the pixels of a picture (`early.js`).
 */
export class Still {
  #door;
  /** @type {Renderer | null} */
  #renderer = null;
  /** Pixels of the screen for one of the page, while the picture moves; null: it does. @type {number | null} */
  #coarse = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #rest;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    if (!isLight()) return;
    if (document.documentElement.dataset.pixels === "fixed") return;
    door.onPicture((renderer) => {
      this.#renderer = renderer;
      this.#wait();
    });
    door.onRedraw(() => this.#move());
    for (const type of ["pointerdown", "wheel", "resize"])
      addEventListener(type, () => this.#move(), { capture: true, passive: true });
  }

  /** The picture is about to change. */
  #move() {
    this.#wait();
    if (this.#coarse === null || !this.#renderer) return;
    this.#renderer.setPixelRatio(this.#coarse);
    this.#coarse = null;
    this.#door.redraw();
  }

  #wait() {
    if (this.#coarse !== null) return;
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => requestAnimationFrame(() => this.#refine()), REST_MS);
  }

  #refine() {
    const { scene, camera } = this.#door.mutable ?? {};
    if (!this.#renderer || !scene || !camera || this.#coarse !== null) return;
    this.#coarse = this.#renderer.getPixelRatio();
    this.#renderer.setPixelRatio(this.#coarse * FINER);
    this.#renderer.render(scene, camera);
  }
}
