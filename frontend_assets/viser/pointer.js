/** @import { CameraView } from "./camera.js" */
/** @import { Door } from "./door.js" */
/** @import { Looks } from "./link-appearance.js" */
/** @import { Measuring } from "./measuring.js" */
/** @import { RobotView } from "./robot.js" */
/** @import { JointView, Vector3 } from "./viser.d.ts" */

import { pick, rayThrough } from "./picking.js";

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
  /** What the mouse points at; null: nothing of the robot. @type {import("./picking.js").Pick | null} */
  #at = null;
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
    window.addEventListener("wheel", () => this.#touch(), { capture: true, passive: true });
    document.addEventListener("pointerleave", () => {
      this.#at = null;
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
      this.#touch();
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
      this.#touch();
    }
  }

  /** A hand is on the camera. */
  #touch() {
    this.#camera.touched();
    this.#tell("touch", {});
  }

  /** Where the mouse points on the robot, in the scene. @returns {Vector3 | null} */
  get point() {
    return this.#at?.point ?? null;
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
      this.#at = pick(this.#door, this.#robot, place.x, place.y);
      this.#hover(this.#at?.link ?? null);
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

/** A plane or line seen at less than this sine is grazed: then the mouse's way on screen counts. */
const GRAZING = 0.2;

/**
 * One joint that follows the mouse. Turning: the angle of the mouse about the axis, in the plane
 * through the place that was gripped; sliding: the point of the axis that is nearest to the mouse.
 * Seen edge-on, the mouse's way along the motion on screen.
 */
class JointDrag {
  /** Of the joint that is set: the gripped one, or the one that it follows. */
  value;
  start;
  #door;
  #gripped;
  #ratio;
  #measure;
  #moved = 0;
  #last;

  /** @param {Door} door @param {RobotView} robot @param {JointView} joint @param {Vector3} grip
   * @param {number} x @param {number} y */
  constructor(door, robot, joint, grip, x, y) {
    const { leader, ratio } = robot.leaderOf(joint);
    this.#door = door;
    this.#gripped = joint;
    this.leader = leader;
    this.#ratio = ratio;
    this.start = robot.positions.get(leader.name) ?? 0;
    this.value = this.start;
    const node = robot.node(joint.child);
    if (!node) throw new Error(`The link "${joint.child}" is not drawn.`);
    const origin = grip.clone().setFromMatrixPosition(node.matrixWorld);
    const axis = grip
      .clone()
      .set(...joint.axis)
      .transformDirection(node.matrixWorld);
    this.#measure = this.#chooseMeasure(origin, axis, grip, x, y);
    this.#last = this.#measure(x, y) ?? 0;
  }

  /** Follow the mouse; whether the value changed. @param {number} x @param {number} y */
  follow(x, y) {
    const now = this.#measure(x, y);
    if (now === null) return false;
    let step = now - this.#last;
    if (this.#gripped.type !== "prismatic") step -= 2 * Math.PI * Math.round(step / (2 * Math.PI));
    this.#last = now;
    this.#moved += step;
    const value = this.#clamped(this.start + this.#moved / this.#ratio);
    const changed = value !== this.value;
    this.value = value;
    return changed;
  }

  /** @param {number} value */
  #clamped(value) {
    const { type, lower, upper } = this.leader;
    if (type === "continuous" || lower === null || upper === null || lower > upper) return value;
    return Math.min(Math.max(value, lower), upper);
  }

  /** How far the joint is at a place of the mouse, rad or m, from some zero; null: cannot be said.
   * @param {Vector3} origin @param {Vector3} axis @param {Vector3} grip @param {number} x @param {number} y
   * @returns {(x: number, y: number) => number | null} */
  #chooseMeasure(origin, axis, grip, x, y) {
    const ray = rayThrough(this.#door, x, y);
    const along = ray ? Math.abs(ray.direction.dot(axis)) : 1;
    if (this.#gripped.type === "prismatic") {
      if (1 - along * along < GRAZING * GRAZING) return this.#screenMeasure(grip, axis, x, y);
      return (mouseX, mouseY) => this.#slide(origin, axis, mouseX, mouseY);
    }
    const centre = origin.clone().addScaledVector(axis, grip.clone().sub(origin).dot(axis));
    const arm = grip.clone().sub(centre);
    if (along < GRAZING || arm.length() < 1e-4) {
      return this.#screenMeasure(grip, axis.clone().cross(arm), x, y);
    }
    const ahead = arm.clone().normalize();
    const aside = axis.clone().cross(ahead);
    return (mouseX, mouseY) => this.#angle(centre, axis, ahead, aside, mouseX, mouseY);
  }

  /** @param {Vector3} origin @param {Vector3} axis @param {number} x @param {number} y */
  #slide(origin, axis, x, y) {
    const ray = rayThrough(this.#door, x, y);
    if (!ray) return null;
    const between = origin.clone().sub(ray.origin);
    const cosine = axis.dot(ray.direction);
    const sine2 = 1 - cosine * cosine;
    if (sine2 < 1e-4) return null;
    return (cosine * between.dot(ray.direction) - between.dot(axis)) / sine2;
  }

  /** @param {Vector3} centre @param {Vector3} axis @param {Vector3} ahead @param {Vector3} aside
   * @param {number} x @param {number} y */
  #angle(centre, axis, ahead, aside, x, y) {
    const ray = rayThrough(this.#door, x, y);
    if (!ray) return null;
    const facing = ray.direction.dot(axis);
    if (Math.abs(facing) < GRAZING / 4) return null;
    const distance = centre.clone().sub(ray.origin).dot(axis) / facing;
    if (distance <= 0) return null;
    const arm = ray.origin.clone().addScaledVector(ray.direction, distance).sub(centre);
    return Math.atan2(arm.dot(aside), arm.dot(ahead));
  }

  /** Pixels along the motion on screen, in rad or m. @param {Vector3} grip
   * @param {Vector3} motion What the grip does for one unit of the joint. @param {number} x0 @param {number} y0
   * @returns {(x: number, y: number) => number} */
  #screenMeasure(grip, motion, x0, y0) {
    const step = 0.01;
    const from = this.#onScreen(grip);
    const to = this.#onScreen(grip.clone().addScaledVector(motion, step));
    const [wayX, wayY] = [(to[0] - from[0]) / step, (to[1] - from[1]) / step];
    const pixels2 = wayX * wayX + wayY * wayY;
    // Seen end-on there is no way on screen: then up is more, a turn for 400 pixels.
    if (pixels2 < 400) return (_, y) => (y0 - y) / 400;
    return (x, y) => ((x - x0) * wayX + (y - y0) * wayY) / pixels2;
  }

  /** @param {Vector3} point @returns {[number, number]} */
  #onScreen(point) {
    const { canvas, camera } = this.#door.mutable ?? {};
    if (!canvas || !camera) return [0, 0];
    const seen = point.clone().project(camera);
    return [(seen.x * canvas.clientWidth) / 2, (-seen.y * canvas.clientHeight) / 2];
  }
}
