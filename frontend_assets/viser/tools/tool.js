/** A tool of the 3D view: what the mouse, a finger or a pen does while it is in hand. */

/**
 * Where the mouse is, and how.
 *
 * @typedef {object} Spot
 * @property {number} x px from the left edge of the window
 * @property {number} y px from its upper edge
 * @property {boolean} free Alt is held: nothing is snapped to
 * @property {boolean} shift
 * @property {boolean} ctrl Ctrl or Cmd
 * @property {boolean} touch it is a finger
 * @property {number} button of a press: 0 is the left one, 2 the right one
 */

/** A press that moves less than this is a click, px. */
const STILL_PX = 4;

/** Whether the mouse went a way. @param {Spot} spot @param {Spot} from */
export function far(spot, from) {
  return Math.hypot(spot.x - from.x, spot.y - from.y) >= STILL_PX;
}

/**
 * The base of all tools, one of which is in hand; the pointer tells it what happens. A press of the
 * left button, or one that it `wants`, is the tool's if `down` says so: then neither the camera nor viser hears of it, and
 * `move` and `up`, or `cancel`, follow. Every other press is the camera's; one that ends where it
 * began is a `click`. With Alt a press is the camera's at once, and so it is with Shift or Ctrl
 * unless `takesModified`.
 */
export class Tool {
  /** Its properties by RViz's names. @type {Readonly<Record<string, boolean | number | string>>} */
  values = {};
  /** Whether it is offered presses with Shift or Ctrl. */
  takesModified = false;

  /** It is taken in hand. */
  take() {}

  /** It is put away, after `cancel`. */
  leave() {}

  /** Whether it is offered a press. @param {Spot} spot */
  wants({ button, shift, ctrl }) {
    return button === 0 && (this.takesModified || !(shift || ctrl));
  }

  /** A press. @param {Spot} _spot @returns {boolean} whether it is the tool's own */
  down(_spot) {
    return false;
  }

  /** Its own press moves; at most once for each picture. @param {Spot} _spot */
  move(_spot) {}

  /** Its own press ends. @param {Spot} _spot */
  up(_spot) {}

  /** A press that was the camera's ended where it began, @param {Spot} _spot here */
  click(_spot) {}

  /** @param {Spot} _spot @returns {boolean} whether two clicks mean something to it: else viser has them */
  doubleClick(_spot) {
    return false;
  }

  /** The mouse moves, and nothing is pressed; at most once for each picture. @param {Spot | null} _spot null: it is away
   * @returns {boolean} whether something of the tool's is there */
  hover(_spot) {
    return false;
  }

  /** The wheel turns while its own press lasts. @param {number} _clicks away from the eye is positive
   * @returns {boolean} whether that means something to it */
  wheel(_clicks) {
    return false;
  }

  /** Give up what is under way: Escape, or the browser takes the press back. @returns {boolean} whether anything was */
  cancel() {
    return false;
  }

  /** After each picture, and while it is not in hand, too: lines and words over the picture. */
  draw() {}
}

/** How the mouse looks over the picture. @param {"" | "crosshair" | "grab" | "grabbing" | "pointer"} name empty: as ever */
export function setCursor(name) {
  if (name) document.documentElement.dataset.cursor = name;
  else delete document.documentElement.dataset.cursor;
}
