/** @import { Door } from "../door.js" */
/** @import { Ground } from "../ground.js" */
/** @import { Dot, Label, Line, Place } from "../screen.js" */
/** @import { Spot } from "./tool.js" */
/** @import { Units } from "./units.js" */

import { fromFixedFrame, groundAt } from "../ground.js";
import { depthOf, pixelAt } from "../orthographic.js";
import { DrawnLines, placeOf } from "../screen.js";
import { far, setCursor, Tool } from "./tool.js";

/** The arrow of a press without a way is so long on the screen, px. */
const HAND_PX = 100;
/** Parts of the length of the arrow: half its shaft, half its head, and where the head begins. */
const ARROW = { shaft: 0.03, head: 0.1, neck: 0.75 };

/**
 * A pose on the ground: pressed at the place and drawn to the direction; without a way it looks along
 * x. It is told when it is released.
 */
export class PoseOnGround extends Tool {
  /** @type {{ spot: Spot, at: Ground, tip: Ground | null } | null} */
  #pressed = null;
  /** Where the mouse is: in the window and on the ground. @type {{ spot: Spot, at: Ground } | null} */
  #aimed = null;
  #lines = new DrawnLines();
  #door;
  #units;
  #tell;

  /** @param {Door} door @param {Units} units @param {(type: string, detail: object) => void} tell */
  constructor(door, units, tell) {
    super();
    this.#door = door;
    this.#units = units;
    this.#tell = tell;
  }

  take() {
    setCursor("crosshair");
  }

  leave() {
    this.hover(null);
    setCursor("");
  }

  /** @param {Spot} spot */
  down(spot) {
    const at = groundAt(this.#door, spot.x, spot.y);
    if (!at) return false;
    this.#pressed = { spot, at, tip: null };
    this.#aimed = { spot, at };
    return true;
  }

  /** @param {Spot} spot */
  move(spot) {
    const pressed = this.#pressed;
    if (!pressed || (!pressed.tip && !far(spot, pressed.spot))) return;
    pressed.tip = groundAt(this.#door, spot.x, spot.y) ?? pressed.tip;
    this.#aimed = { spot, at: pressed.at };
    this.#door.redraw();
  }

  /** @param {Spot} spot */
  up(spot) {
    const pressed = this.#pressed;
    this.#pressed = null;
    if (!pressed) return;
    const [x, y] = pressed.at;
    this.#tell("pose", { x, y, yaw: yawOf(pressed) });
    // A finger that was lifted aims at nothing any more.
    if (spot.touch) this.hover(null);
  }

  doubleClick() {
    return true;
  }

  /** @param {Spot | null} spot */
  hover(spot) {
    const at = spot && groundAt(this.#door, spot.x, spot.y);
    this.#aimed = spot && at && { spot, at };
    this.#door.redraw();
    return at !== null;
  }

  cancel() {
    const wasPressed = this.#pressed !== null;
    this.#pressed = null;
    this.#aimed = null;
    this.#door.redraw();
    return wasPressed;
  }

  draw() {
    /** @type {{ lines: Line[], dots: Dot[], labels: Label[] }} */
    const all = { lines: [], dots: [], labels: [] };
    const [pressed, aimed] = [this.#pressed, this.#aimed];
    if (pressed) {
      const places = this.#arrow(pressed);
      if (places) all.lines.push({ places, kind: "arrow" });
    }
    if (aimed) {
      const place = this.#seen(aimed.at);
      if (place) all.dots.push({ place, kind: "tool" });
      const text = this.#words(aimed.at, pressed && yawOf(pressed));
      all.labels.push({ place: [aimed.spot.x, aimed.spot.y], text, kind: "aim" });
    }
    this.#lines.draw(all);
  }

  /** @param {Ground} at @param {number | null} yaw rad */
  #words([x, y], yaw) {
    const [across, along, unit] = this.#units.length(x, y).split(/\s+/);
    const place = `x ${across}  y ${along} ${unit}`;
    return yaw === null ? place : `${place}  yaw ${this.#units.angle(yaw)}`;
  }

  /** The outline of an arrow that lies on the ground. @param {{ at: Ground, tip: Ground | null }} pressed
   * @returns {Place[] | null} null: part of it is behind the eye */
  #arrow({ at, tip }) {
    const end = tip ?? [at[0] + this.#handLength(at), at[1]];
    const [wayX, wayY] = [end[0] - at[0], end[1] - at[1]];
    const corner = (/** @type {number} */ along, /** @type {number} */ aside) =>
      this.#seen([at[0] + along * wayX - aside * wayY, at[1] + along * wayY + aside * wayX]);
    const { shaft, head, neck } = ARROW;
    const outline = [
      corner(0, shaft),
      corner(neck, shaft),
      corner(neck, head),
      corner(1, 0),
      corner(neck, -head),
      corner(neck, -shaft),
      corner(0, -shaft),
      corner(0, shaft),
    ];
    const seen = outline.filter((place) => place !== null);
    return seen.length === outline.length ? seen : null;
  }

  /** How long an arrow without a way is on the ground, m; with perspective and without. @param {Ground} at */
  #handLength(at) {
    const { camera, canvas } = this.#door.mutable ?? {};
    const point = fromFixedFrame(this.#door, [...at, 0]);
    if (!camera || !canvas || !point) return 1;
    return HAND_PX * pixelAt(camera, depthOf(camera, point), canvas.clientHeight);
  }

  /** @param {Ground} at @returns {Place | null} */
  #seen(at) {
    const point = fromFixedFrame(this.#door, [...at, 0]);
    return point && placeOf(this.#door, point);
  }
}

/** rad about z, from x. @param {{ at: Ground, tip: Ground | null }} pressed */
function yawOf({ at, tip }) {
  return tip ? Math.atan2(tip[1] - at[1], tip[0] - at[0]) : 0;
}
