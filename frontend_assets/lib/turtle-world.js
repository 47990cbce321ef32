/** One ground of turtlesim as this page has seen it: who is on it, where, and what was drawn. */

/** @import { Pen } from "./turtles.js" */
/** @import { Drawn, Paper } from "./turtle-field.js" */

import { Trail } from "./turtle-trail.js";
import { colorOf } from "./turtles.js";

/** As turtlesim begins. */
export const BACKGROUND = colorOf(69, 86, 255);
/** @type {Pen} */
export const FIRST_PEN = { color: colorOf(179, 184, 255), width: 3, isDown: true };
/** What some tell of ground that nobody drew on, whatever it looks like. */
const BLANK = colorOf(255, 255, 255);

/**
 * @typedef {Drawn & {forward: number, turn: number, isHere: boolean, trail: Trail, pen: Pen}} OnField
 *   `forward`, `turn`: m/s, rad/s; `isHere`: it was heard of
 */

export class World {
  /** @param {Paper} paper */
  constructor(paper) {
    this.paper = paper;
    this.background = BACKGROUND;
    /** @type {Map<string, OnField>} */
    this.turtles = new Map();
    /** Pens as they were set, by turtle. @type {Map<string, Pen>} */
    this.pens = new Map();
    /** Something is to be drawn anew. */
    this.isStale = true;
    this.count = 0;
  }

  /** @param {readonly string[]} names those that are there; what others drew stays */
  keepOnly(names) {
    for (const name of this.turtles.keys())
      if (!names.includes(name)) {
        this.turtles.delete(name);
        this.pens.delete(name);
      }
    for (const name of names)
      if (!this.turtles.has(name)) this.turtles.set(name, this.newcomer(name));
    this.isStale = true;
  }

  /** @param {string} name @returns {OnField} */
  newcomer(name) {
    const shell = this.count;
    this.count += 1;
    const pen = this.pens.get(name) ?? FIRST_PEN;
    return {
      ...{ name, shell, x: 0, y: 0, theta: 0, forward: 0, turn: 0 },
      ...{ isHere: false, trail: new Trail(), pen },
    };
  }

  /** @param {string} name @param {Float64Array} times @param {readonly Float64Array[]} columns x, y, heading, forward and turn */
  addPoses(name, times, [x, y, theta, forward, turn]) {
    const turtle = this.turtles.get(name);
    if (!turtle || !x || !y) return;
    turtle.trail.addPoses(times, x, y);
    const now = [x, y, theta, forward, turn].map((column) => column?.at(-1) ?? Number.NaN);
    if (!now.every(Number.isFinite)) return;
    const before = [turtle.x, turtle.y, turtle.theta, turtle.forward, turtle.turn];
    if (turtle.isHere && now.every((value, n) => value === before[n])) return;
    [turtle.x, turtle.y, turtle.theta, turtle.forward, turtle.turn] = /** @type {any} */ (now);
    turtle.isHere = true;
    this.isStale = true;
  }

  /** @param {string} name @param {Float64Array} times @param {readonly Float64Array[]} columns red, green and blue */
  addColors(name, times, [red, green, blue]) {
    const colors = Array.from(times, (_, n) =>
      colorOf(red?.[n] ?? 0, green?.[n] ?? 0, blue?.[n] ?? 0),
    );
    this.turtles.get(name)?.trail.addColors(times, colors);
  }

  /** @param {number} color of the bare ground */
  setBackground(color) {
    if (color === this.background) return;
    this.background = color;
    for (const { trail } of this.turtles.values()) trail.forgetGround();
    this.isStale = true;
  }

  /** @param {string} name @param {Pen} pen that somebody gave a turtle */
  setPen(name, pen) {
    this.pens.set(name, pen);
    const turtle = this.turtles.get(name);
    if (turtle) turtle.pen = pen;
  }

  wipe() {
    this.paper.wipe();
    this.isStale = true;
  }

  /** All begins anew; who is there is told by the wire. */
  reset() {
    this.pens.clear();
    for (const turtle of this.turtles.values()) turtle.pen = FIRST_PEN;
    this.wipe();
  }

  /** Draw what the turtles drew since the last time. @returns {boolean} whether the field looks otherwise now */
  settle() {
    const takes = [...this.turtles.values()].map((turtle) => ({ turtle, ...this.taken(turtle) }));
    if (takes.some(({ wiped }) => wiped)) this.wipe();
    for (const { turtle, strokes } of takes) {
      if (strokes.length === 0 || !turtle.pen.isDown) continue;
      this.paper.draw(strokes, turtle.pen.width);
      this.isStale = true;
    }
    const was = this.isStale;
    this.isStale = false;
    return was;
  }

  /** @param {OnField} turtle */
  taken({ trail, pen }) {
    const isBare = (/** @type {number} */ color) =>
      color === this.background || (color === BLANK && pen.color !== BLANK);
    return trail.take(isBare, pen.color);
  }
}
