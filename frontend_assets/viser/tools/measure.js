/** @import { Measuring } from "../measuring.js" */
/** @import { Spot } from "./tool.js" */

import { setCursor, Tool } from "./tool.js";

/** RViz's first colour, dark yellow: with it, lines have that of the theme, which is seen on its background. */
const RVIZ_COLOUR = "#808000";

/** A click takes what it is aimed at as an end of a measure; no joint is dragged. */
export class Measure extends Tool {
  #measuring;
  #tell;

  /** @param {Measuring} measuring @param {(type: string, detail: object) => void} tell */
  constructor(measuring, tell) {
    super();
    this.#measuring = measuring;
    this.#tell = tell;
  }

  take() {
    setCursor("crosshair");
  }

  leave() {
    this.#measuring.hover(null);
    setCursor("");
  }

  /** @param {Spot} spot */
  click(spot) {
    const anchor = this.#measuring.take(spot);
    if (anchor) this.#tell("measure", { anchor });
    // A finger that was lifted aims at nothing any more.
    if (spot.touch) this.#measuring.hover(null);
  }

  /** Two clicks near to each other measure something short. */
  doubleClick() {
    return true;
  }

  /** @param {Spot | null} spot */
  hover(spot) {
    this.#measuring.hover(spot);
    return spot !== null;
  }

  draw() {
    const colour = String(this.values["Line color"] ?? RVIZ_COLOUR);
    this.#measuring.draw(colour === RVIZ_COLOUR ? "" : colour);
  }
}
