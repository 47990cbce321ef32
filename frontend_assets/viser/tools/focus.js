/** @import { CameraView } from "../camera.js" */
/** @import { Door } from "../door.js" */
/** @import { Surfaces } from "../surface.js" */
/** @import { Spot } from "./tool.js" */

import { rayThrough } from "../picking.js";
import { setCursor, Tool } from "./tool.js";

/** A click turns the camera to what is there, as RViz does; where nothing is, it looks that way. */
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
    const point = surface?.point ?? (ray && this.#ahead(ray));
    if (!point) return;
    this.#camera.lookAt(point);
    this.#tell("focus", { link: surface?.link ?? null });
  }

  /** As far away as what is looked at; without perspective a ray begins behind the eye.
   * @param {import("../surface.js").Ray} ray */
  #ahead({ origin, direction }) {
    const eye = this.#door.mutable?.camera?.position.clone() ?? origin.clone();
    const toEye = eye.sub(origin).dot(direction);
    return origin.addScaledVector(direction, toEye + this.#camera.distance());
  }

  doubleClick() {
    return true;
  }
}
