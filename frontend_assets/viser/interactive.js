/** @import { Door } from "./door.js" */
/** @import { Mouse, Pose } from "./handle-drag.js" */
/** @import { Control, Handle, Known, MarkerScene, Markers } from "./marker-scene.js" */

import { HandleDrag, isDragged, Mode, plus, times, VIEW_FACING } from "./handle-drag.js";
import { DrawnLines, placeOf } from "./screen.js";

/** @typedef {{ id: number, x: number, y: number, handle: Handle, drag: HandleDrag | null, moved: boolean, menu: boolean, timer: number, start: Pose, startRad: number }} Press `menu`: only the menu is meant */

const HOVER = 0.3;
const ACTIVE = 0.5;
const STILL_PX = 4;
const LONG_PRESS_MS = 500;
/** After a release, until the studio has heard of it; and from then on, until its scene has it. */
const PATIENCE_MS = 1500;
const SETTLE_MS = 150;
const WHEEL_PX = 100;

/**
 * Interactive markers under the mouse: hover, drags, clicks and menus. What is dragged moves in this
 * browser at once, and the page tells the studio.
 *
 * It listens before `Pointer` does, and keeps from it and from viser what is meant for a control.
 * Tells `marker {display, marker, control, action, ...}`, `marker_menu {..., x, y}`, `marker_hover` and
 * `marker_denied`.
 */
export class Interactive {
  /** @type {Press | null} */
  #press = null;
  /** @type {Handle | null} */
  #over = null;
  /** @type {Mouse | null} */
  #newest = null;
  #looks = false;
  #on = true;
  #may = false;
  #lines = new DrawnLines();
  #door;
  #scene;
  #isBusy;
  #tell;

  /** @param {Door} door @param {MarkerScene} scene @param {() => boolean} isBusy something else has the mouse, as measuring
   * @param {(type: string, detail: object) => void} tell */
  constructor(door, scene, isBusy, tell) {
    this.#door = door;
    this.#scene = scene;
    this.#isBusy = isBusy;
    this.#tell = tell;
    door.onPicture(
      () => {},
      () => this.#drawAids(),
    );
    this.#listen();
  }

  /** What can be done with which markers. @param {readonly Markers[]} displays */
  set(displays) {
    this.#scene.set(displays);
    const press = this.#press;
    const now = press && this.#scene.known.get(press.handle.known.root);
    if (press && !now) this.#drop();
    else if (press && now) press.handle = { ...press.handle, known: now };
    if (this.#over && !this.#scene.known.has(this.#over.known.root)) this.#hover(null);
  }

  /** Whether this person may move them. @param {boolean} may */
  setMay(may) {
    this.#may = may;
    if (!may) this.cancel();
  }

  /** Whether the tool that is chosen moves them; else only what is always visible is seen. @param {boolean} on */
  setOn(on) {
    this.#on = on;
    this.#scene.all = on;
    if (!on) this.cancel();
    this.#hover(null);
    this.#door.redraw();
  }

  get dragging() {
    return this.#press !== null;
  }

  /** Give the pose at the press back. */
  cancel() {
    const press = this.#press;
    if (!press) return;
    if (press.drag) {
      press.drag = null;
      this.#scene.keep(press.handle.known, press.start, press.handle.control, press.startRad);
    }
    this.#release(false);
  }

  /** The studio did not take it: its own word counts at once. @param {string} display @param {number} marker */
  refused(display, marker) {
    const root = `/live/${display}/m${marker}`;
    if (this.#press?.handle.known.root === root) this.#drop();
    this.#scene.giveBack(root);
  }

  /** The studio has heard of the release. @param {string} display @param {number} marker */
  settle(display, marker) {
    const root = `/live/${display}/m${marker}`;
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

  #listen() {
    const options = { capture: true };
    window.addEventListener("pointerdown", (event) => this.#down(event), options);
    window.addEventListener("pointermove", (event) => this.#move(event), options);
    window.addEventListener("pointerup", (event) => this.#up(event), options);
    window.addEventListener("pointercancel", () => this.cancel(), options);
    window.addEventListener("blur", () => this.cancel());
    const wheel = (/** @type {WheelEvent} */ event) => this.#wheel(event);
    window.addEventListener("wheel", wheel, { capture: true, passive: false });
    document.addEventListener("pointerleave", () => !this.#press && this.#hover(null));
    window.addEventListener("dblclick", (event) => this.#keepFromOthers(event), options);
  }

  /** @param {MouseEvent} event */
  #keepFromOthers(event) {
    if (this.#over && !event.altKey) event.stopImmediatePropagation();
  }

  get #isActive() {
    return this.#on && this.#scene.known.size > 0 && !this.#isBusy();
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (event.target !== this.#door.mutable?.canvas || !this.#isActive) return;
    if (this.#press || event.altKey || event.button === 1) return;
    const handle = this.#scene.pick(event.clientX, event.clientY);
    const meant = handle && meaningOf(event, handle);
    if (!handle || !meant) return;
    window.focus();
    event.stopImmediatePropagation();
    event.preventDefault();
    if (this.#may) this.#begin(event, handle, meant === "menu");
    else this.#tell("marker_denied", {});
  }

  /** @param {PointerEvent} event @param {Handle} handle @param {boolean} menu */
  #begin(event, handle, menu) {
    const { clientX: x, clientY: y, pointerId: id } = event;
    const { known, control } = handle;
    this.#door.mutable?.canvas?.setPointerCapture(id);
    this.#hover(handle);
    const isTouch = event.pointerType === "touch";
    const timer = isTouch ? window.setTimeout(() => this.#longPress(), LONG_PRESS_MS) : 0;
    const start = this.#scene.poseOf(known);
    const startRad = control ? this.#scene.radOf(known, control) : 0;
    const drag =
      !menu && control && isDragged(control.mode)
        ? this.#dragOf(known, control, handle, start, startRad, mouseOf(event))
        : null;
    this.#press = { id, x, y, handle, drag, moved: false, menu, timer, start, startRad };
    this.#lightUp();
    if (menu) return;
    if (drag) this.#scene.keep(known, start, control, startRad);
    setCursor(drag ? "grabbing" : "pointer");
    this.#say("press");
  }

  /** @param {Known} known @param {Control} control @param {Handle} handle @param {Pose} start @param {number} rad @param {Mouse} mouse */
  #dragOf(known, control, handle, start, rad, mouse) {
    const grab = this.#scene.toReference(known, handle.point);
    return new HandleDrag(control, this.#scene.sightFrom(known), start, rad, grab, mouse);
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const press = this.#press;
    if (press) {
      if (event.pointerId !== press.id) return;
      event.stopImmediatePropagation();
      press.moved ||= Math.hypot(event.clientX - press.x, event.clientY - press.y) >= STILL_PX;
      if (press.moved) clearTimeout(press.timer);
      this.#newest = mouseOf(event);
      this.#look();
      return;
    }
    if (event.buttons !== 0 || !this.#isActive) return;
    // Where the mouse was last decides whether others hear of it: they are one picture late.
    if (this.#over) event.stopImmediatePropagation();
    this.#newest = mouseOf(event);
    this.#look();
  }

  /** At most once for each picture. */
  #look() {
    if (this.#looks) return;
    this.#looks = true;
    requestAnimationFrame(() => {
      this.#looks = false;
      const mouse = this.#newest;
      this.#newest = null;
      if (!mouse) return;
      if (this.#press) this.#follow(mouse);
      else if (this.#isActive) this.#hover(this.#scene.pick(mouse.x, mouse.y));
    });
  }

  /** @param {Mouse} mouse */
  #follow(mouse) {
    const { drag } = this.#press ?? {};
    if (drag?.follow(mouse)) this.#moved(drag);
  }

  /** @param {HandleDrag} drag */
  #moved({ pose, rad }) {
    const { handle } = this.#press ?? {};
    if (!handle) return;
    this.#scene.keep(handle.known, pose, handle.control, rad);
    this.#say("move");
  }

  /** @param {PointerEvent} event */
  #up(event) {
    const press = this.#press;
    if (!press || event.pointerId !== press.id) return;
    event.stopImmediatePropagation();
    if (this.#newest) this.#follow(mouseOf(event));
    const { handle, menu, moved } = press;
    const { clientX: x, clientY: y } = event;
    const here = this.#scene.pick(x, y);
    const isSame = here?.known.root === handle.known.root && here.control === handle.control;
    if (menu) this.#drop();
    else this.#release(isSame);
    this.#hover(event.pointerType === "touch" ? null : here);
    const isAsked = menu ? event.button === 2 : handle.control?.mode === Mode.MENU && isSame;
    if (isAsked && !moved) this.#openMenu(handle, x, y);
  }

  #longPress() {
    const press = this.#press;
    if (!press || press.moved || !hasMenu(press.handle)) return;
    if (press.menu) this.#drop();
    else this.#release(false);
    this.#openMenu(press.handle, press.x, press.y);
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    const press = this.#press;
    if (!press) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    if (press.drag?.wheel(-event.deltaY / WHEEL_PX)) this.#moved(press.drag);
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
    this.#newest = null;
    this.#hover(null);
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

  /** @param {Handle | null} handle */
  #hover(handle) {
    const before = this.#over;
    this.#over = handle;
    const isSame = before?.known === handle?.known && before?.control === handle?.control;
    if (isSame && (before === null) === (handle === null)) return;
    setCursor(cursorOf(handle));
    this.#tell("marker_hover", handle ? targetOf(handle) : { display: "", marker: null, control: null });
    this.#lightUp();
  }

  #lightUp() {
    const handle = this.#press?.handle ?? this.#over;
    this.#scene.lit = handle && { handle, strength: this.#press ? ACTIVE : HOVER };
    this.#door.redraw();
  }

  /** The axis along or about which something is moved. */
  #drawAids() {
    const { handle, drag } = this.#press ?? {};
    const control = handle?.control;
    const hasAxis = control && control.facing !== VIEW_FACING && HAS_AXIS.has(control.mode);
    const places = drag && hasAxis && handle.known.aids ? this.#axisOf(handle.known, drag) : [];
    const lines = places.length > 1 ? [{ places, kind: /** @type {const} */ ("axis") }] : [];
    this.#lines.draw({ lines, dots: [], labels: [] });
  }

  /** @param {Known} known @param {HandleDrag} drag @returns {import("./screen.js").Place[]} */
  #axisOf(known, { line: { point, along } }) {
    const sight = this.#scene.sightFrom(known);
    const reach = 20 * known.marker.scale;
    return [-1, -0.1, 0, 0.1, 1].flatMap((share) => {
      const place = sight.placeOf(plus(point, times(along, share * reach)));
      return place ? [place] : [];
    });
  }
}

/** @type {ReadonlySet<number>} */
const HAS_AXIS = new Set([Mode.MOVE_AXIS, Mode.ROTATE_AXIS, Mode.MOVE_ROTATE]);

/** @param {MouseEvent} event @returns {Mouse} */
const mouseOf = ({ clientX: x, clientY: y, shiftKey: shift, ctrlKey, metaKey }) => ({
  x,
  y,
  shift,
  ctrl: ctrlKey || metaKey,
});

/** @param {Handle} handle */
const targetOf = ({ known, control }) => ({
  display: known.display,
  marker: known.marker.number,
  control: control?.number ?? null,
});

/** @param {Handle} handle */
const hasMenu = ({ known }) => known.marker.menu.length > 0;

/** What a press on a control means; null: nothing, it is the camera's.
 * @param {PointerEvent} event @param {Handle} handle @returns {"handle" | "menu" | null} */
function meaningOf({ button, pointerType }, handle) {
  if (button === 0 && (handle.control?.mode ?? Mode.NONE) !== Mode.NONE) return "handle";
  const isMenu = button === 2 || pointerType === "touch";
  return isMenu && hasMenu(handle) ? "menu" : null;
}

/** @param {Handle | null} handle */
function cursorOf(handle) {
  if (!handle) return "";
  const mode = handle.control?.mode ?? Mode.NONE;
  if (isDragged(mode)) return "grab";
  return mode === Mode.NONE ? "" : "pointer";
}

/** @param {string} cursor empty: the usual one */
function setCursor(cursor) {
  if (cursor) document.documentElement.dataset.cursor = cursor;
  else delete document.documentElement.dataset.cursor;
}
