/** @import { CameraView } from "../camera.js" */
/** @import { Door } from "../door.js" */
/** @import { Surfaces } from "../surface.js" */
/** @import { Spot } from "./tool.js" */

import { rayThrough } from "../picking.js";
import { setCursor, Tool } from "./tool.js";

/** A click brings what is there to the middle, from the same side and as far away; where nothing is, the
 * camera looks that way. */
export class FocusCamera extends Tool {
  #door;
  #surfaces;
  #camera;
  #tell;

  /** @param {Door} door @param {Surfaces} surfaces @param {CameraView} camera
   * @param {(type: string, detail: object) => void} tell */
  constructor(door, surfaces, camera, tell) {
    super();
    this.#door = door;
    this.#surfaces = surfaces;
    this.#camera = camera;
    this.#tell = tell;
  }

  take() {
    setCursor("crosshair");
  }

  leave() {
    setCursor("");
  }

  /** @param {Spot} spot */
  click({ x, y }) {
    const surface = this.#surfaces.at(x, y);
    const ray = rayThrough(this.#door, x, y);
    const ahead = ray?.origin.addScaledVector(ray.direction, this.#camera.distance());
    const point = surface?.point ?? ahead;
    if (!point) return;
    this.#camera.lookAt(point);
    this.#tell("focus", { link: surface?.link ?? null });
  }

  doubleClick() {
    return true;
  }
}
