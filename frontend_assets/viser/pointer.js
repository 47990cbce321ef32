/** @import { Door } from "./door.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { Spot, Tool } from "./tools/tool.js" */
/** @import { Vector3 } from "./viser.d.ts" */

import { pick } from "./picking.js";
import { far } from "./tools/tool.js";

/** A notch of a wheel in browsers. */
const WHEEL_PX = 100;

/** The mouse, a finger or a pen over the picture: what it does is told to the tool in hand. */
export class Pointer {
  /** @type {Tool} */
  #tool;
  /** A press; `own`: it is the tool's. @type {{ spot: Spot, id: number, own: boolean } | null} */
  #pressed = null;
  /** A press that was the tool's is told to the camera. */
  #isHandingOver = false;
  /** Where it is since the last picture. @type {Spot | null} */
  #newest = null;
  /** Where the mouse is; null: it is away. @type {Spot | null} */
  #at = null;
  #door;
  #robot;
  #touch;

  /** @param {Door} door @param {RobotView} robot @param {Tool[]} tools the first is in hand
   * @param {() => void} touch called when a hand is on the camera */
  constructor(door, robot, tools, touch) {
    this.#door = door;
    this.#robot = robot;
    this.#tool = /** @type {Tool} */ (tools[0]);
    this.#touch = touch;
    this.#listen();
    door.onPicture(
      () => {},
      () => {
        for (const one of tools) one.draw();
      },
    );
  }

  get tool() {
    return this.#tool;
  }

  /** Take another tool in hand. @param {Tool} tool */
  hold(tool) {
    if (tool === this.#tool) return;
    this.cancel();
    this.#tool.leave();
    this.#tool = tool;
    tool.take();
    if (this.#at && !this.#pressed) this.#newest = this.#at;
    this.#door.redraw();
  }

  /** Give up the press that is the tool's. @returns {boolean} whether anything was under way */
  cancel() {
    if (this.#pressed?.own) this.#pressed = null;
    return this.#tool.cancel();
  }

  /** Where the mouse is, px; null: not over the picture. @returns {{ x: number, y: number } | null} */
  get place() {
    return this.#at;
  }

  /** Where the mouse points on the robot, in the scene. @returns {Vector3 | null} */
  get point() {
    const at = this.#at;
    return (at && pick(this.#door, this.#robot, at.x, at.y)?.point) ?? null;
  }

  /** The browser takes a press for itself. */
  #lose() {
    this.cancel();
    this.#pressed = null;
  }

  #listen() {
    const options = { capture: true };
    window.addEventListener("pointerdown", (event) => this.#down(event), options);
    window.addEventListener("pointermove", (event) => this.#move(event), options);
    window.addEventListener("pointerup", (event) => this.#up(event), options);
    window.addEventListener("pointercancel", () => this.#lose(), options);
    window.addEventListener("blur", () => this.cancel());
    const wheel = (/** @type {WheelEvent} */ event) => this.#wheel(event);
    window.addEventListener("wheel", wheel, { capture: true, passive: false });
    document.addEventListener("pointerleave", () => {
      this.#at = this.#newest = null;
      if (!this.#pressed) this.#tool.hover(null);
    });
    window.addEventListener("dblclick", (event) => this.#doubleClick(event), options);
    window.addEventListener("contextmenu", (event) => event.preventDefault(), options);
    this.#everyPicture();
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (event.target !== this.#door.mutable?.canvas) return;
    window.focus();
    if (this.#isHandingOver) return;
    if (this.#pressed?.own && event.pointerId !== this.#pressed.id) {
      this.#handOver(this.#at ?? this.#pressed.spot, this.#pressed.id);
      this.#touch();
      return;
    }
    const spot = spotOf(event);
    this.#at = spot;
    const modified = spot.shift || spot.ctrl;
    const isPlain = event.button === 0 && (this.#tool.takesModified || !modified);
    const own = !spot.free && this.#tool.wants(spot) && this.#tool.down(spot);
    if (own || isPlain) this.#pressed = { spot, id: event.pointerId, own };
    if (own) {
      // Neither viser nor the camera shall hear of it.
      event.stopImmediatePropagation();
      event.preventDefault();
      this.#door.mutable?.canvas?.setPointerCapture(event.pointerId);
      this.#door.redraw();
    } else {
      this.#touch();
    }
  }

  /** A second finger moves the camera: what the first one began was not meant, and is the camera's, too.
   * @param {Spot} at where the first one is @param {number} id */
  #handOver({ x: clientX, y: clientY }, id) {
    this.cancel();
    const init = { pointerId: id, pointerType: "touch", clientX, clientY, buttons: 1, bubbles: true };
    this.#isHandingOver = true;
    this.#door.mutable?.canvas?.dispatchEvent(new PointerEvent("pointerdown", init));
    this.#isHandingOver = false;
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const pressed = this.#pressed;
    const isOwn = pressed?.own && event.pointerId === pressed.id;
    if (event.buttons === 0 || isOwn) {
      this.#newest = spotOf(event);
      this.#door.redraw();
    }
    this.#at = event.target === this.#door.mutable?.canvas ? spotOf(event) : null;
    if (isOwn) event.stopImmediatePropagation();
  }

  /** @param {PointerEvent} event */
  #up(event) {
    const pressed = this.#pressed;
    if (!pressed || event.pointerId !== pressed.id) return;
    this.#pressed = this.#newest = null;
    const spot = spotOf(event);
    if (pressed.own) {
      event.stopImmediatePropagation();
      this.#tool.move(spot);
      this.#tool.up(spot);
      this.#door.redraw();
    } else if (!far(spot, pressed.spot)) {
      this.#tool.click(spot);
    }
    if (spot.touch) this.#at = null;
  }

  /** @param {MouseEvent} event */
  #doubleClick(event) {
    if (event.target !== this.#door.mutable?.canvas) return;
    if (this.#tool.doubleClick(spotOf(event))) event.stopImmediatePropagation();
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    if (!this.#pressed?.own || !this.#tool.wheel(-event.deltaY / WHEEL_PX)) return this.#touch();
    event.preventDefault();
    return event.stopImmediatePropagation();
  }

  /** At most once for each picture, however often the mouse reports. */
  #everyPicture() {
    requestAnimationFrame(() => this.#everyPicture());
    const spot = this.#newest;
    if (!spot) return;
    this.#newest = null;
    if (this.#pressed?.own) this.#tool.move(spot);
    else if (!this.#pressed) this.#tool.hover(spot);
  }
}

/** @param {MouseEvent} event @returns {Spot} */
function spotOf(event) {
  const { clientX: x, clientY: y, altKey: free, shiftKey: shift, ctrlKey, metaKey, button } = event;
  const touch = "pointerType" in event && event.pointerType === "touch";
  return { x, y, free, shift, ctrl: ctrlKey || metaKey, touch, button };
}
