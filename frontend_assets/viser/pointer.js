/** @import { CameraView } from "./camera.js" */
/** @import { Door } from "./door.js" */
/** @import { Looks } from "./looks.js" */
/** @import { Measuring } from "./measuring.js" */
/** @import { RobotView } from "./robot.js" */
import { JointDrag } from "./joint-drag.js";
import { pick } from "./picking.js";

/** A press that moves less than this is a click, px. */
const STILL_PX = 4;

/**
 * The mouse over the robot. Pressing on a link that a joint moves and drawing the mouse moves the
 * joint; anywhere else, or with Alt held, it moves the camera. A press without a way is a click. While
 * something is measured no joint is dragged, and a click takes what it is aimed at.
 */
export class Pointer {
  /** Whether links may be dragged: one who only looks may not. */
  canDrag = true;
  /** @type {"deg" | "rad"} */
  angleUnit = "deg";
  /** @type {{ x: number, y: number, id: number, link: string | null, grip: import("./picking.js").Pick | null } | null} */
  #pressed = null;
  /** @type {JointDrag | null} */
  #drag = null;
  /** `free`: nothing is snapped to. @type {{ x: number, y: number, free: boolean } | null} */
  #newest = null;
  #door;
  #robot;
  #looks;
  #camera;
  #measuring;
  #tell;
  #label = document.createElement("output");

  /** @param {Door} door @param {RobotView} robot @param {Looks} looks @param {CameraView} camera
   * @param {Measuring} measuring @param {(type: string, detail: object) => void} tell */
  constructor(door, robot, looks, camera, measuring, tell) {
    this.#door = door;
    this.#robot = robot;
    this.#looks = looks;
    this.#camera = camera;
    this.#measuring = measuring;
    this.#tell = tell;
    this.#label.className = "studio-drag-label";
    this.#label.hidden = true;
    this.#listen();
  }

  get dragging() {
    return this.#drag !== null;
  }

  /** Give the start value back. */
  cancel() {
    const drag = this.#drag;
    if (!drag) return;
    drag.value = drag.start;
    this.#tellDrag("cancel");
    this.#endDrag();
    this.#pressed = null;
  }

  #listen() {
    const options = { capture: true };
    window.addEventListener("pointerdown", (event) => this.#down(event), options);
    window.addEventListener("pointermove", (event) => this.#move(event), options);
    window.addEventListener("pointerup", (event) => this.#up(event), options);
    window.addEventListener("pointercancel", () => this.cancel(), options);
    window.addEventListener("blur", () => this.cancel());
    window.addEventListener("wheel", () => this.#camera.touched(), {
      capture: true,
      passive: true,
    });
    document.addEventListener("pointerleave", () => {
      this.#hover(null);
      this.#measuring.hover(null);
    });
    window.addEventListener("dblclick", (event) => this.#doubleClick(event), options);
    window.addEventListener("contextmenu", (event) => event.preventDefault(), options);
    this.#everyPicture();
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (event.target !== this.#door.mutable?.canvas) return;
    window.focus();
    if (event.button !== 0 || event.shiftKey || event.ctrlKey || event.metaKey) {
      this.#camera.touched();
      return;
    }
    const found = pick(this.#door, this.#robot, event.clientX, event.clientY);
    const { clientX: x, clientY: y, pointerId: id } = event;
    this.#pressed = { x, y, id, link: found?.link ?? null, grip: null };
    if (found && !event.altKey && this.#movable(found.link)) {
      this.#pressed.grip = found;
      // Neither viser nor the camera shall hear of a press that grips a link.
      event.stopImmediatePropagation();
      event.preventDefault();
      this.#door.mutable?.canvas?.setPointerCapture(id);
    } else {
      this.#camera.touched();
    }
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const pressed = this.#pressed;
    if (event.buttons === 0 || pressed?.grip) {
      this.#newest = placeOf(event);
      this.#door.redraw();
    }
    if (!pressed?.grip || event.pointerId !== pressed.id) return;
    event.stopImmediatePropagation();
    if (!this.#drag && far(event, pressed)) this.#beginDrag(pressed);
  }

  /** @param {PointerEvent} event */
  #up(event) {
    const pressed = this.#pressed;
    if (!pressed || event.pointerId !== pressed.id) return;
    this.#pressed = null;
    if (pressed.grip) event.stopImmediatePropagation();
    if (this.#drag) {
      this.#drag.follow(event.clientX, event.clientY);
      this.#newest = placeOf(event);
      this.#tellDrag("end");
      this.#endDrag();
    } else if (!far(event, pressed)) {
      this.#click(event, pressed.link);
    }
  }

  /** @param {PointerEvent} event @param {string | null} link */
  #click(event, link) {
    if (this.#measuring.on) {
      const anchor = this.#measuring.take(placeOf(event));
      if (anchor) this.#tell("measure", { anchor });
      // A finger that was lifted aims at nothing any more.
      if (event.pointerType === "touch") this.#measuring.hover(null);
    } else {
      this.#looks.setSelected(link);
      this.#tell("select", { link });
    }
  }

  /** @param {MouseEvent} event */
  #doubleClick(event) {
    if (event.target !== this.#door.mutable?.canvas) return;
    // Two clicks near to each other measure something short.
    if (this.#measuring.on) return event.stopImmediatePropagation();
    const found = pick(this.#door, this.#robot, event.clientX, event.clientY);
    if (!found) return undefined;
    event.stopImmediatePropagation();
    this.#camera.focus(found.link);
    this.#tell("focus", { link: found.link });
    return undefined;
  }

  /** At most once for each picture, however often the mouse reports. */
  #everyPicture() {
    requestAnimationFrame(() => this.#everyPicture());
    const place = this.#newest;
    if (!place) return;
    this.#newest = null;
    if (this.#drag) {
      const changed = this.#drag.follow(place.x, place.y);
      this.#placeLabel(place);
      if (changed) this.#tellDrag("move", place);
    } else if (this.#measuring.on) {
      this.#aimAt(place);
    } else if (!this.#pressed) {
      this.#hover(pick(this.#door, this.#robot, place.x, place.y)?.link ?? null);
    }
  }

  /** @param {{ x: number, y: number, free: boolean }} place */
  #aimAt(place) {
    this.#hover(null);
    document.documentElement.dataset.cursor = "crosshair";
    if (!this.#pressed) this.#measuring.hover(place);
  }

  /** @param {{ x: number, y: number, grip: import("./picking.js").Pick | null }} pressed */
  #beginDrag(pressed) {
    const joint = pressed.grip && this.#robot.jointThatMoves(pressed.grip.link);
    if (!joint || !pressed.grip) return;
    const { x, y, grip } = pressed;
    this.#drag = new JointDrag(this.#door, this.#robot, joint, grip.point, x, y);
    document.documentElement.dataset.cursor = "grabbing";
    document.body.append(this.#label);
    this.#tellDrag("start", pressed);
  }

  #endDrag() {
    this.#drag = null;
    this.#label.hidden = true;
    delete document.documentElement.dataset.cursor;
  }

  /** @param {"start" | "move" | "end" | "cancel"} phase @param {{ x: number, y: number } | null} [place] */
  #tellDrag(phase, place = this.#newest) {
    if (!this.#drag) return;
    const { leader, value } = this.#drag;
    const { x = 0, y = 0 } = place ?? {};
    this.#tell("drag", { joint: leader.name, value, phase, x, y });
  }

  /** @param {{ x: number, y: number }} place */
  #placeLabel({ x, y }) {
    if (!this.#drag) return;
    this.#label.hidden = false;
    this.#label.textContent = `${this.#drag.leader.name}  ${this.#valueText()}`;
    this.#label.style.transform = `translate(${Math.round(x + 16)}px, ${Math.round(y + 18)}px)`;
  }

  #valueText() {
    if (!this.#drag) return "";
    const { value, leader } = this.#drag;
    if (leader.type === "prismatic") return `${value.toFixed(4)} m`;
    if (this.angleUnit === "rad") return `${value.toFixed(3)} rad`;
    return `${((value * 180) / Math.PI).toFixed(1)}°`;
  }

  /** @param {string | null} link */
  #hover(link) {
    if (link === this.#looks.hovered) return;
    this.#looks.setHovered(link);
    const cursor = link === null ? "" : this.#movable(link) ? "grab" : "pointer";
    document.documentElement.dataset.cursor = cursor;
    this.#tell("hover", { link });
  }

  /** @param {string} link */
  #movable(link) {
    return this.canDrag && !this.#measuring.on && this.#robot.jointThatMoves(link) !== null;
  }
}

/** @param {PointerEvent} event @param {{ x: number, y: number }} from */
function far(event, from) {
  return Math.hypot(event.clientX - from.x, event.clientY - from.y) >= STILL_PX;
}

/** @param {MouseEvent} event */
function placeOf({ clientX: x, clientY: y, altKey: free }) {
  return { x, y, free };
}
