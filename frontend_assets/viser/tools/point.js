/** @import { Door } from "../door.js" */
/** @import { Surface, Surfaces } from "../surface.js" */
/** @import { Dot, Label } from "../screen.js" */
/** @import { Spot } from "./tool.js" */
/** @import { Units } from "./units.js" */

import { inFixedFrame } from "../ground.js";
import { DrawnLines, placeOf } from "../screen.js";
import { setCursor, Tool } from "./tool.js";

/** The share of the time that looking for surfaces may take: a large cloud takes long. */
const SHARE = 1 / 4;

/**
 * A point of a surface: what a click here means stands at the mouse, and the point is told. The page
 * says what things are called.
 */
export class SurfacePoint extends Tool {
  /** Names of displays by id, and words for the floor and for nothing. @type {{ displays: Record<string, string>, floor: string, nothing: string }} */
  words = { displays: {}, floor: "", nothing: "" };
  /** @type {{ spot: Spot, surface: Surface | null } | null} */
  #aimed = null;
  #restsUntil_ms = 0;
  #lines = new DrawnLines();
  #door;
  #surfaces;
  #units;
  #tell;

  /** @param {Door} door @param {Surfaces} surfaces @param {Units} units
   * @param {(type: string, detail: object) => void} tell */
  constructor(door, surfaces, units, tell) {
    super();
    this.#door = door;
    this.#surfaces = surfaces;
    this.#units = units;
    this.#tell = tell;
  }

  leave() {
    this.hover(null);
    setCursor("");
  }

  /** @param {Spot} spot */
  click(spot) {
    const surface = this.#surfaces.at(spot.x, spot.y);
    const point = surface && inFixedFrame(this.#door, surface.point);
    if (surface && point) this.#tell("point", { point, what: this.#nameOf(surface) });
    if (spot.touch) this.hover(null);
  }

  doubleClick() {
    return true;
  }

  /** @param {Spot | null} spot */
  hover(spot) {
    const began_ms = performance.now();
    if (spot && began_ms < this.#restsUntil_ms) {
      // Where the mouse came to rest meanwhile is looked at in its turn.
      const { x, y } = spot;
      const isNewest = () => this.#aimed?.spot.x === x && this.#aimed.spot.y === y;
      setTimeout(() => isNewest() && this.hover(spot), this.#restsUntil_ms - began_ms);
      this.#aimed = { spot, surface: null };
      return true;
    }
    this.#aimed = spot && { spot, surface: this.#surfaces.at(spot.x, spot.y) };
    const ended_ms = performance.now();
    this.#restsUntil_ms = ended_ms + (ended_ms - began_ms) * (1 / SHARE - 1);
    setCursor(this.#aimed?.surface ? "crosshair" : "");
    this.#door.redraw();
    return Boolean(this.#aimed?.surface);
  }

  draw() {
    /** @type {{ dots: Dot[], labels: Label[] }} */
    const all = { dots: [], labels: [] };
    if (this.#aimed) {
      const { spot, surface } = this.#aimed;
      const place = surface && placeOf(this.#door, surface.point);
      if (place) all.dots.push({ place, kind: "tool" });
      const text = surface ? this.#words(surface) : this.words.nothing;
      if (text) all.labels.push({ place: [spot.x, spot.y], text, kind: "aim" });
    }
    this.#lines.draw({ lines: [], ...all });
  }

  /** @param {Surface} surface */
  #words(surface) {
    const point = inFixedFrame(this.#door, surface.point);
    return point ? `${this.#nameOf(surface)}  ${this.#units.length(...point)}` : "";
  }

  /** @param {Surface} surface */
  #nameOf({ link, display }) {
    if (link !== null) return link;
    return display === null ? this.words.floor : (this.words.displays[display] ?? display);
  }
}
