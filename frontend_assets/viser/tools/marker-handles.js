/** @import { Door } from "../door.js" */
/** @import { Pose } from "../handle-drag.js" */
/** @import { Control, Handle, Known, MarkerScene, Markers } from "../marker-scene.js" */
/** @import { Spot } from "./tool.js" */

import { HandleDrag, isDragged, Mode, VIEW_FACING } from "../handle-drag.js";
import { referenceOf } from "../marker-scene.js";
import { DrawnLines, placeOf } from "../screen.js";
import { far, setCursor, Tool } from "./tool.js";
import { plus, times } from "../../lib/vectors.js";

/** @typedef {{ spot: Spot, handle: Handle, drag: HandleDrag | null, moved: boolean, menu: boolean, timer: number, start: Pose, startRad: number }} Press `menu`: only the menu is meant */

const HOVER = 0.3;
const ACTIVE = 0.5;
const LONG_PRESS_MS = 500;
/** After a release, until the studio has heard of it; and from then on, until its scene has it. */
const PATIENCE_MS = 1500;
const SETTLE_MS = 150;

/**
 * Handles of interactive markers: hover, drags, clicks and menus. What is dragged moves in this browser
 * at once, and the page tells the studio.
 *
 * Tells `marker {display, marker, control, action, ...}`, `marker_menu {..., x, y}`, `marker_hover` and
 * `marker_denied`.
 */
export class MarkerHandles extends Tool {
  takesModified = true;
  /** Whether this person may move them. */
  #may = false;
  /** @type {Press | null} */
  #press = null;
  /** @type {Handle | null} */
  #over = null;
  #lines = new DrawnLines();
  #door;
  #scene;
  #tell;

  /** @param {Door} door @param {MarkerScene} scene @param {(type: string, detail: object) => void} tell */
  constructor(door, scene, tell) {
    super();
    this.#door = door;
    this.#scene = scene;
    this.#tell = tell;
  }

  /** What can be done with which markers. @param {readonly Markers[]} displays */
  set(displays) {
    this.#scene.set(displays);
    const press = this.#press;
    const now = press && this.#scene.known.get(press.handle.known.root);
    if (press && !now) this.#drop();
    else if (press && now) press.handle = { ...press.handle, known: now };
    if (this.#over && !this.#scene.known.has(this.#over.known.root)) this.#point(null);
  }

  /** @param {boolean} may */
  setMay(may) {
    this.#may = may;
    if (!may) this.cancel();
  }

  /** The studio did not take it: its own word counts at once. @param {string} display @param {number} marker */
  refused(display, marker) {
    const root = referenceOf(display, marker);
    if (this.#press?.handle.known.root === root) this.#drop();
    this.#scene.giveBack(root);
  }

  /** The studio has heard of the release. @param {string} display @param {number} marker */
  settle(display, marker) {
    const root = referenceOf(display, marker);
    if (this.#press?.handle.known.root !== root) this.#scene.release(root, SETTLE_MS);
  }

  /** Open the menu of what the mouse is over; whether there is one. */
  menuHere() {
    const handle = this.#over;
    if (!handle || !hasMenu(handle) || !this.#may) return false;
    const [x, y] = placeOf(this.#door, handle.point) ?? [0, 0];
    this.#openMenu(handle, x, y);
    return true;
  }

  take() {
    this.#scene.all = true;
  }

  /** With another tool only what is always visible is seen, as in RViz. */
  leave() {
    this.#scene.all = false;
    this.#point(null);
  }

  /** @param {Spot} spot */
  wants(spot) {
    return spot.button !== 1 && this.#meantAt(spot) !== null;
  }

  /** @param {Spot} spot */
  down(spot) {
    const found = this.#meantAt(spot);
    if (!found) return false;
    const [handle, means] = found;
    if (this.#may) this.#begin(spot, handle, means === "menu");
    else this.#tell("marker_denied", {});
    return true;
  }

  /** @param {Spot} spot */
  move(spot) {
    const press = this.#press;
    if (!press) return;
    press.moved ||= far(spot, press.spot);
    if (press.moved) clearTimeout(press.timer);
    if (press.drag?.follow(spot)) this.#moved(press.drag);
  }

  /** @param {Spot} spot */
  up(spot) {
    const press = this.#press;
    if (!press) return;
    const { handle, menu, moved } = press;
    const here = this.#scene.pick(spot.x, spot.y);
    const isSame = here?.known.root === handle.known.root && here.control === handle.control;
    if (menu) this.#drop();
    else this.#release(isSame);
    this.#point(spot.touch ? null : here);
    const isAsked = menu ? press.spot.button === 2 : handle.control?.mode === Mode.MENU && isSame;
    if (isAsked && !moved) this.#openMenu(handle, spot.x, spot.y);
  }

  /** @param {Spot} spot */
  doubleClick(spot) {
    return this.#scene.pick(spot.x, spot.y) !== null;
  }

  /** @param {Spot | null} spot */
  hover(spot) {
    this.#point(spot && this.#scene.pick(spot.x, spot.y));
    return this.#over !== null;
  }

  /** The wheel, while the button is down. @param {number} clicks away from the eye is positive */
  wheel(clicks) {
    const { drag } = this.#press ?? {};
    if (!drag?.wheel(clicks)) return false;
    this.#moved(drag);
    return true;
  }

  /** Give the pose at the press back. */
  cancel() {
    const press = this.#press;
    if (!press) return false;
    if (press.drag) {
      press.drag = null;
      this.#scene.keep(press.handle.known, press.start, press.handle.control, press.startRad);
    }
    this.#release(false);
    return true;
  }

  /** The axis along or about which something is moved. */
  draw() {
    const { handle, drag } = this.#press ?? {};
    const control = handle?.control;
    const hasAxis = control && control.facing !== VIEW_FACING && HAS_AXIS.has(control.mode);
    const places = drag && hasAxis && handle.known.aids ? this.#axisOf(handle.known, drag) : [];
    const lines = places.length > 1 ? [{ places, kind: /** @type {const} */ ("axis") }] : [];
    this.#lines.draw({ lines, dots: [], labels: [] });
  }

  /** @param {Spot} spot @returns {[Handle, "handle" | "menu"] | null} */
  #meantAt(spot) {
    if (this.#press || this.#scene.known.size === 0) return null;
    const handle = this.#scene.pick(spot.x, spot.y);
    const means = handle && meaningOf(spot, handle);
    return handle && means ? [handle, means] : null;
  }

  /** @param {Spot} spot @param {Handle} handle @param {boolean} menu */
  #begin(spot, handle, menu) {
    const { known, control } = handle;
    this.#point(handle);
    const timer = spot.touch ? window.setTimeout(() => this.#longPress(), LONG_PRESS_MS) : 0;
    const start = this.#scene.poseOf(known);
    const startRad = control ? this.#scene.radOf(known, control) : 0;
    const drag =
      !menu && control && isDragged(control.mode)
        ? this.#dragOf(known, control, handle, start, startRad, spot)
        : null;
    this.#press = { spot, handle, drag, moved: false, menu, timer, start, startRad };
    this.#lightUp();
    if (menu) return;
    if (this.values["Hide Inactive Objects"] !== false) this.#scene.only = known.root;
    if (drag) this.#scene.keep(known, start, control, startRad);
    setCursor(drag ? "grabbing" : "pointer");
    this.#say("press");
  }

  /** @param {Known} known @param {Control} control @param {Handle} handle @param {Pose} start @param {number} rad @param {Spot} spot */
  #dragOf(known, control, handle, start, rad, spot) {
    const grab = this.#scene.toReference(known, handle.point);
    return new HandleDrag(control, this.#scene.sightFrom(known), start, rad, grab, spot);
  }

  /** @param {HandleDrag} drag */
  #moved({ pose, rad }) {
    const { handle } = this.#press ?? {};
    if (!handle) return;
    this.#scene.keep(handle.known, pose, handle.control, rad);
    this.#say("move");
  }

  #longPress() {
    const press = this.#press;
    if (!press || press.moved || !hasMenu(press.handle)) return;
    if (press.menu) this.#drop();
    else this.#release(false);
    this.#openMenu(press.handle, press.spot.x, press.spot.y);
  }

  /** @param {boolean} clicked */
  #release(clicked) {
    const press = this.#press;
    if (!press) return;
    this.#say("release", clicked);
    this.#scene.release(press.handle.known.root, PATIENCE_MS);
    this.#drop();
  }

  #drop() {
    clearTimeout(this.#press?.timer);
    this.#press = null;
    this.#scene.only = null;
    this.#point(null);
    setCursor("");
    this.#door.redraw();
  }

  /** @param {"press" | "move" | "release"} action @param {boolean} [clicked] */
  #say(action, clicked = false) {
    const press = this.#press;
    if (!press) return;
    const { handle, drag, start, startRad } = press;
    const { turn, place } = drag?.pose ?? start;
    this.#tell("marker", {
      ...targetOf(handle),
      action,
      position: place,
      orientation: turn,
      turn_rad: drag?.rad ?? startRad,
      mouse_point: action === "move" ? null : this.#scene.toReference(handle.known, handle.point),
      clicked,
    });
  }

  /** @param {Handle} handle @param {number} x @param {number} y px of this window */
  #openMenu(handle, x, y) {
    const frame = window.frameElement?.getBoundingClientRect();
    this.#tell("marker_menu", {
      ...targetOf(handle),
      mouse_point: this.#scene.toReference(handle.known, handle.point),
      x: x + (frame?.left ?? 0),
      y: y + (frame?.top ?? 0),
    });
  }

  /** The mouse is over another handle, or over none. @param {Handle | null} handle */
  #point(handle) {
    const before = this.#over;
    this.#over = handle;
    if (handle) setCursor(cursorOf(handle));
    const isSame = before?.known === handle?.known && before?.control === handle?.control;
    if (isSame && (before === null) === (handle === null)) return;
    if (!handle) setCursor("");
    this.#tell("marker_hover", handle ? targetOf(handle) : NOTHING);
    this.#lightUp();
  }

  #lightUp() {
    const handle = this.#press?.handle ?? this.#over;
    this.#scene.lit = handle && { handle, strength: this.#press ? ACTIVE : HOVER };
    this.#door.redraw();
  }

  /** @param {Known} known @param {HandleDrag} drag @returns {import("../screen.js").Place[]} */
  #axisOf(known, { line: { point, along } }) {
    const sight = this.#scene.sightFrom(known);
    const reach = 20 * known.marker.scale;
    return [-1, -0.1, 0, 0.1, 1].flatMap((share) => {
      const place = sight.placeOf(plus(point, times(along, share * reach)));
      return place ? [place] : [];
    });
  }
}

const NOTHING = { display: "", marker: null, control: null };
/** @type {ReadonlySet<number>} */
const HAS_AXIS = new Set([Mode.MOVE_AXIS, Mode.ROTATE_AXIS, Mode.MOVE_ROTATE]);

/** @param {Handle} handle */
const targetOf = ({ known, control }) => ({
  display: known.display,
  marker: known.marker.number,
  control: control?.number ?? null,
});

/** @param {Handle} handle */
const hasMenu = ({ known }) => known.marker.menu.length > 0;

/** What a press on a control means; null: nothing, it is the camera's.
 * @param {Spot} spot @param {Handle} handle @returns {"handle" | "menu" | null} */
function meaningOf({ button, touch }, handle) {
  if (button === 0 && (handle.control?.mode ?? Mode.NONE) !== Mode.NONE) return "handle";
  return (button === 2 || touch) && hasMenu(handle) ? "menu" : null;
}

/** @param {Handle} handle */
function cursorOf(handle) {
  const mode = handle.control?.mode ?? Mode.NONE;
  if (isDragged(mode)) return "grab";
  return mode === Mode.NONE ? "" : "pointer";
}
