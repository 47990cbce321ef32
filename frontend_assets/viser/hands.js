/** @import { CameraView } from "./camera.js" */
/** @import { Door } from "./door.js" */
/** @import { Way } from "../lib/view-moves.js" */

import { fromFixedFrame } from "./ground.js";
import { depthOf, pixelAt } from "./orthographic.js";
import { placeOf } from "./screen.js";

/** Of a wheel that counts lines, or pages. */
const LINE_PX = 40;
const PAGE_PX = 400;
/** A notch has so many pixels in browsers, and 120 in RViz. */
const RVIZ_PER_PX = 1.2;
/** Fingers that spread on a trackpad are told as a wheel, in small numbers. */
const SPREAD = 10;

/** @typedef {{x: number, y: number}} Place px */

/**
 * Mouse, wheel and fingers on the camera. `rviz`: left turns, middle (or Shift and left) moves, right
 * or wheel zooms, with Shift along the line of sight; `trackpad`: right moves, too. One finger turns,
 * two move and zoom. A press that something else took, such as a joint's, does not come here.
 */
export class Hands {
  /** @type {"rviz" | "trackpad"} */
  mouse = "rviz";
  #door;
  #camera;
  #mark;
  /** Where each pointer is that was pressed on the picture. @type {Map<number, Place>} */
  #held = new Map();

  /** @param {Door} door @param {CameraView} camera */
  constructor(door, camera) {
    this.#door = door;
    this.#camera = camera;
    this.#mark = new FocalMark(door, camera);
    const options = { capture: true };
    window.addEventListener("pointerdown", (event) => this.#down(event), options);
    window.addEventListener("pointermove", (event) => this.#move(event), options);
    for (const type of /** @type {const} */ (["pointerup", "pointercancel"]))
      window.addEventListener(type, (event) => this.#up(event), options);
    window.addEventListener("blur", () => this.#letGo());
    window.addEventListener("wheel", (event) => this.#wheel(event), { ...options, passive: false });
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (event.target !== this.#door.mutable?.canvas) return;
    this.#held.set(event.pointerId, placeOfEvent(event));
    this.#mark.show();
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const now = placeOfEvent(event);
    const before = this.#held.get(event.pointerId);
    if (!before) return;
    this.#held.set(event.pointerId, now);
    if (this.#held.size > 1) this.#spread(event.pointerId, before, now);
    else this.#drag(event, before, now);
  }

  /** @param {PointerEvent} event @param {Place} before @param {Place} now */
  #drag(event, before, now) {
    const way = event.pointerType === "touch" ? "turn" : this.#wayOf(event);
    if (!way) return this.#letGo(); // the button came up where nobody saw it
    return this.#camera.drag(way, now.x - before.x, now.y - before.y, [now.x, now.y]);
  }

  /** @param {PointerEvent} event @returns {Way | null} */
  #wayOf({ buttons, shiftKey, ctrlKey }) {
    const right = (buttons & 2) !== 0 || ((buttons & 1) !== 0 && ctrlKey);
    if (buttons & 4 || (buttons & 1 && shiftKey)) return "move";
    if (right) return this.mouse === "trackpad" ? "move" : shiftKey ? "lift" : "zoom";
    return buttons & 1 ? "turn" : null;
  }

  /** Two fingers: their middle moves the view, their distance zooms.
   * @param {number} id of the finger that moved @param {Place} before @param {Place} now */
  #spread(id, before, now) {
    const other = [...this.#held].find(([one]) => one !== id)?.[1];
    if (!other) return;
    const between = (/** @type {Place} */ one) => Math.hypot(one.x - other.x, one.y - other.y);
    const at = /** @type {const} */ ([(now.x + other.x) / 2, (now.y + other.y) / 2]);
    this.#camera.drag("move", (now.x - before.x) / 2, (now.y - before.y) / 2, at);
    this.#camera.pinch(Math.max(between(now), 1) / Math.max(between(before), 1));
  }

  /** @param {PointerEvent} event */
  #up({ pointerId, buttons, pointerType }) {
    if (pointerType !== "touch" && buttons !== 0) return; // of a mouse, another button is still down
    this.#held.delete(pointerId);
    if (this.#held.size === 0) this.#letGo();
  }

  #letGo() {
    this.#held.clear();
    this.#mark.hide();
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    if (event.target !== this.#door.mutable?.canvas) return;
    event.preventDefault();
    const unit = [1, LINE_PX, PAGE_PX][event.deltaMode] ?? 1;
    // With Shift a browser scrolls to the side.
    const way = (event.deltaY || event.deltaX) * unit * (event.ctrlKey ? SPREAD : 1);
    this.#camera.wheel(-way * RVIZ_PER_PX, event.shiftKey);
  }
}

/** @param {PointerEvent} event @returns {Place} */
const placeOfEvent = ({ clientX: x, clientY: y }) => ({ x, y });

/** Seen from the side, RViz's focal shape is a fifth as high as it is wide. */
const FLATNESS = 1 / 5;

/** RViz's focal shape: a disk at what an orbit turns about, while a hand is on the camera. */
class FocalMark {
  #door;
  #camera;
  #element = document.createElement("div");
  #isShown = false;

  /** @param {Door} door @param {CameraView} camera */
  constructor(door, camera) {
    this.#door = door;
    this.#camera = camera;
    this.#element.className = "studio-focal";
    this.#element.hidden = true;
    door.onPicture(
      () => undefined,
      () => this.#isShown && this.#draw(),
    );
  }

  show() {
    this.#isShown = true;
    document.body.append(this.#element);
    this.#door.redraw();
  }

  hide() {
    this.#isShown = false;
    this.#element.hidden = true;
  }

  #draw() {
    const focal = this.#camera.focal;
    const { camera, canvas } = this.#door.mutable ?? {};
    const point = focal && fromFixedFrame(this.#door, focal.place);
    const place = point && placeOf(this.#door, point);
    this.#element.hidden = !place;
    if (!focal || !point || !place || !camera || !canvas) return;
    const wide = focal.size / pixelAt(camera, depthOf(camera, point), canvas.clientHeight);
    const tall = wide * Math.hypot(Math.sin(focal.slope), FLATNESS * Math.cos(focal.slope));
    this.#element.classList.toggle("ground", focal.isGround);
    Object.assign(this.#element.style, {
      width: `${wide.toFixed(1)}px`,
      height: `${tall.toFixed(1)}px`,
      transform: `translate(${place[0].toFixed(1)}px, ${place[1].toFixed(1)}px) translate(-50%, -50%)`,
    });
  }
}
