/** @import { CameraView } from "../camera.js" */
/** @import { Door } from "../door.js" */
/** @import { Looks } from "../link-appearance.js" */
/** @import { Pick } from "../picking.js" */
/** @import { RobotView } from "../robot.js" */
/** @import { Spot } from "./tool.js" */
/** @import { Units } from "./units.js" */

import { pick } from "../picking.js";
import { JointDrag } from "./joint-drag.js";
import { far, setCursor, Tool } from "./tool.js";

/**
 * Links and handles. Pressing on a link that a joint moves and drawing the mouse moves the joint; a
 * click selects a link, two bring it to the middle.
 */
export class Interact extends Tool {
  /** Whether links may be dragged: one who only looks may not. */
  canDrag = true;
  /** What lies over the robot and is asked first, such as the handles of interactive markers; each
   * is called as a tool is. @type {Tool[]} */
  handles = [];
  /** The one of them that a press is of. @type {Tool | null} */
  #held = null;
  /** @type {{ spot: Spot, grip: Pick } | null} */
  #pressed = null;
  /** @type {JointDrag | null} */
  #drag = null;
  #door;
  #robot;
  #looks;
  #camera;
  #units;
  #tell;
  #label = document.createElement("output");

  /** @param {Door} door @param {RobotView} robot @param {Looks} looks @param {CameraView} camera
   * @param {Units} units @param {(type: string, detail: object) => void} tell */
  constructor(door, robot, looks, camera, units, tell) {
    super();
    this.#door = door;
    this.#robot = robot;
    this.#looks = looks;
    this.#camera = camera;
    this.#units = units;
    this.#tell = tell;
    this.#label.className = "studio-drag-label";
    this.#label.hidden = true;
  }

  take() {
    for (const one of this.handles) one.take();
  }

  leave() {
    for (const one of this.handles) one.leave();
    this.#hoverLink(null);
  }

  /** @param {Spot} spot */
  wants(spot) {
    return super.wants(spot) || this.handles.some((one) => one.wants(spot));
  }

  /** @param {Spot} spot */
  down(spot) {
    for (const one of this.handles) one.values = this.values;
    this.#held = this.handles.find((one) => one.down(spot)) ?? null;
    if (this.#held) return true;
    if (!super.wants(spot)) return false;
    const grip = pick(this.#door, this.#robot, spot.x, spot.y);
    if (!grip || !this.#movable(grip.link)) return false;
    this.#pressed = { spot, grip };
    return true;
  }

  /** @param {Spot} spot */
  move(spot) {
    if (this.#held) return this.#held.move(spot);
    if (!this.#drag && this.#pressed && far(spot, this.#pressed.spot)) this.#begin(this.#pressed);
    if (!this.#drag) return undefined;
    const changed = this.#drag.follow(spot.x, spot.y);
    this.#placeLabel(spot);
    if (changed) this.#tellDrag("move", spot);
    return undefined;
  }

  /** @param {Spot} spot */
  up(spot) {
    const [held, pressed] = [this.#held, this.#pressed];
    this.#held = this.#pressed = null;
    if (held) return held.up(spot);
    if (this.#drag) {
      this.#drag.follow(spot.x, spot.y);
      this.#tellDrag("end", spot);
      this.#end();
    } else if (pressed && !far(spot, pressed.spot)) {
      this.#select(pressed.grip.link);
    }
    return undefined;
  }

  /** @param {Spot} spot */
  click(spot) {
    this.#select(pick(this.#door, this.#robot, spot.x, spot.y)?.link ?? null);
  }

  /** @param {Spot} spot */
  doubleClick(spot) {
    if (this.handles.some((one) => one.doubleClick(spot))) return true;
    const found = pick(this.#door, this.#robot, spot.x, spot.y);
    if (!found) return false;
    this.#camera.focus(found.link);
    this.#tell("focus", { link: found.link });
    return true;
  }

  /** @param {Spot | null} spot */
  hover(spot) {
    // Each hears of it: one that is left looks as before again.
    const overHandle = this.handles.map((one) => one.hover(spot)).includes(true);
    const at = spot && !overHandle ? pick(this.#door, this.#robot, spot.x, spot.y) : null;
    this.#hoverLink(at?.link ?? null);
    return overHandle || at !== null;
  }

  /** @param {number} clicks */
  wheel(clicks) {
    return this.#held?.wheel(clicks) ?? false;
  }

  /** Give the start value back. */
  cancel() {
    const [held, pressed] = [this.#held, this.#pressed];
    this.#held = this.#pressed = null;
    if (held) return held.cancel();
    if (!this.#drag) return pressed !== null;
    this.#drag.value = this.#drag.start;
    this.#tellDrag("cancel", pressed?.spot ?? null);
    this.#end();
    return true;
  }

  draw() {
    for (const one of this.handles) one.draw();
  }

  /** @param {string | null} link */
  #select(link) {
    this.#looks.setSelected(link);
    this.#tell("select", { link });
  }

  /** @param {{ spot: Spot, grip: Pick }} pressed */
  #begin({ spot, grip }) {
    const joint = this.#robot.jointThatMoves(grip.link);
    if (!joint) return;
    this.#drag = new JointDrag(this.#door, this.#robot, joint, grip.point, spot.x, spot.y);
    setCursor("grabbing");
    document.body.append(this.#label);
    this.#tellDrag("start", spot);
  }

  #end() {
    this.#drag = null;
    this.#label.hidden = true;
    setCursor("");
  }

  /** @param {"start" | "move" | "end" | "cancel"} phase @param {Spot | null} spot */
  #tellDrag(phase, spot) {
    if (!this.#drag) return;
    const { leader, value } = this.#drag;
    const { x = 0, y = 0 } = spot ?? {};
    this.#tell("drag", { joint: leader.name, value, phase, x, y });
  }

  /** @param {Spot} spot */
  #placeLabel({ x, y }) {
    if (!this.#drag) return;
    const { leader, value } = this.#drag;
    const text =
      leader.type === "prismatic" ? `${value.toFixed(4)} m` : this.#units.angle(value);
    this.#label.hidden = false;
    this.#label.textContent = `${leader.name}  ${text}`;
    this.#label.style.transform = `translate(${Math.round(x + 16)}px, ${Math.round(y + 18)}px)`;
  }

  /** @param {string | null} link */
  #hoverLink(link) {
    if (link === this.#looks.hovered) return;
    this.#looks.setHovered(link);
    setCursor(link === null ? "" : this.#movable(link) ? "grab" : "pointer");
    this.#tell("hover", { link });
  }

  /** @param {string} link */
  #movable(link) {
    return this.canDrag && this.#robot.jointThatMoves(link) !== null;
  }
}
