/**
 * One ground of turtlesim as this page has seen it: the turtles on it, told by the names and
 * types of topics and services, and the lines they draw.
 */

/** @import { OfferView, TopicRow } from "../../types/wire.d.ts" */
/** @import { Drawn, Paper, Stroke } from "./drawing.js" */

import { drivable } from "../../model/driving.js";

/**
 * @typedef {{name: string, type: string}} Service
 * @typedef {{name: string, path: string, pose: string, color: string, drive: {name: string, stamped: boolean} | null}} Turtle
 *   `path`: what its topics and services begin with; `color`: empty where nobody tells it
 * @typedef {{prefix: string, node: string, turtles: readonly Turtle[]}} Ground
 *   `prefix`: the namespace, as "" or "/left"; `node`: full name of the one that serves it, empty: none does
 */

const POSE = /^turtlesim(_msgs)?\/msg\/Pose$/;
const COLOR = /^turtlesim(_msgs)?\/msg\/Color$/;
const SPAWN = /^turtlesim(_msgs)?\/srv\/Spawn$/;
/** More are not drawn: a page hears so many topics at most. */
const TURTLES_MAX = 60;

/**
 * @param {readonly TopicRow[]} topics
 * @param {readonly OfferView[]} services
 * @returns {Ground[]} by their namespaces
 */
export function groundsOf(topics, services) {
  /** @type {Map<string, {prefix: string, node: string, turtles: Turtle[]}>} */
  const found = new Map();
  const at = (/** @type {string} */ prefix) => {
    const ground = found.get(prefix) ?? { prefix, node: "", turtles: [] };
    found.set(prefix, ground);
    return ground;
  };
  for (const { name, types, nodes } of services)
    if (types.some((type) => SPAWN.test(type))) at(parentOf(name)).node = nodes[0] ?? "";
  const byName = new Map(topics.map((one) => [one.name, one]));
  for (const topic of topics)
    if (topic.publishers > 0 && topic.types.some((type) => POSE.test(type)))
      addTurtle(at(parentOf(pathOf(topic.name))).turtles, topic.name, byName);
  for (const { turtles } of found.values()) turtles.sort(byNumber);
  return [...found.values()].sort((a, b) => (a.prefix < b.prefix ? -1 : 1));
}

const { compare } = new Intl.Collator("en", { numeric: true });
/** `turtle10` comes after `turtle9`. @param {Turtle} a @param {Turtle} b */
const byNumber = (a, b) => compare(a.name, b.name);

/** @param {Turtle[]} turtles @param {string} pose @param {ReadonlyMap<string, TopicRow>} topics */
function addTurtle(turtles, pose, topics) {
  const path = pathOf(pose);
  const color = topics.get(`${path}/color_sensor`);
  const driven = topics.get(`${path}/cmd_vel`);
  if (turtles.length >= TURTLES_MAX) return;
  turtles.push({
    name: path.slice(path.lastIndexOf("/") + 1),
    path,
    pose,
    color: color?.types.some((type) => COLOR.test(type)) ? color.name : "",
    drive: driven ? (drivable([driven])[0] ?? null) : null,
  });
}

/** @param {string} pose a topic @returns {string} of its turtle */
const pathOf = (pose) => (pose.endsWith("/pose") ? pose.slice(0, -"/pose".length) : pose);

/** @param {string} name @returns {string} the namespace that it is in */
const parentOf = (name) => name.slice(0, Math.max(0, name.lastIndexOf("/")));

/**
 * @param {readonly OfferView[]} services
 * @param {string} name
 * @returns {Service | null} null: nobody serves it
 */
export function serviceNamed(services, name) {
  const found = services.find((one) => one.name === name);
  return found?.types[0] === undefined ? null : { name, type: found.types[0] };
}

/** @typedef {{color: number, width: number, isDown: boolean}} Pen `color`: 0xrrggbb; `width`: px of turtlesim's window */

const PART = /["']?\b([a-z]+)["']?\s*:\s*["']?(\d+)/g;

/** @param {string} text the request of a SetPen that was answered, so it can be read @returns {Pen} what is not named is 0 */
export function penOf(text) {
  const parts = new Map([...text.matchAll(PART)].map(([, name, value]) => [name, Number(value)]));
  const part = (/** @type {string} */ name) => (parts.get(name) ?? 0) & 255;
  return {
    color: colorOf(part("r"), part("g"), part("b")),
    width: part("width"),
    isDown: part("off") === 0,
  };
}

/** @param {number} red 0 to 255 @param {number} green @param {number} blue @returns {number} 0xrrggbb */
export const colorOf = (red, green, blue) => (red << 16) | (green << 8) | blue;

/** @param {string} hex `#rrggbb` @returns {[number, number, number]} red, green and blue, 0 to 255 */
export function bytesOf(hex) {
  const color = Number.parseInt(hex.slice(1), 16);
  return [(color >> 16) & 255, (color >> 8) & 255, color & 255];
}

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

/**
 * @typedef {{x: number, y: number}} Point metres, from the lower left corner
 * @typedef {{time: number, x: number, y: number}} Placed
 * @typedef {{time: number, color: number}} Seen
 */

/** The colour counts that is told so much later: it is that of where the turtle then is. */
const LATER_S = 0.03;
/** So long a colour is waited for. */
const PATIENCE_S = 0.15;
/** A line goes on over bare ground that is seen for no longer: some tell the colour before they draw. */
const BRIDGE_S = 0.1;
/** What was not heard for so long is not known. */
const GAP_S = 0.5;
/** Who stood for so long and has bare ground below it now was not moved: the ground was wiped. */
const STANDING_S = 0.1;
const KEPT = 4000;

/**
 * The line that a turtle draws, as far as the wire tells it.
 *
 * A turtle tells where it is and, on a topic of its own, the colour of the ground below it. Nobody
 * tells of the pen: where a turtle has moved and the ground below it is not bare, it drew in that
 * colour, or crossed a line of it, which looks the same.
 */
export class Trail {
  constructor() {
    /** @type {Placed[]} */
    this.poses = [];
    /** @type {Seen[]} */
    this.colors = [];
    /** @type {Placed | null} */
    this.last = null;
    /** @type {Placed | null} */
    this.drawn = null;
    this.stoodSince_s = Number.POSITIVE_INFINITY;
    this.isOnLine = false;
  }

  /** @param {ArrayLike<number>} times s @param {ArrayLike<number>} x m @param {ArrayLike<number>} y m; what is no number is left out */
  addPoses(times, x, y) {
    for (let n = 0; n < times.length; n += 1) {
      const one = { time: times[n] ?? 0, x: x[n] ?? Number.NaN, y: y[n] ?? Number.NaN };
      if (Number.isFinite(one.x) && Number.isFinite(one.y)) this.poses.push(one);
    }
    this.poses.splice(0, this.poses.length - KEPT);
  }

  /** @param {ArrayLike<number>} times s @param {readonly number[]} colors 0xrrggbb */
  addColors(times, colors) {
    colors.forEach((color, n) => {
      this.colors.push({ time: times[n] ?? 0, color });
    });
    this.colors.splice(0, this.colors.length - KEPT);
  }

  /** The bare ground looks otherwise now. */
  forgetGround() {
    this.isOnLine = false;
  }

  /**
   * @param {(color: number) => boolean} isBare
   * @param {number} unseen the colour of a line where nobody tells any
   * @returns {{strokes: Stroke[], wiped: boolean}} what was drawn since the last time
   */
  take(isBare, unseen) {
    /** @type {{strokes: Stroke[], wiped: boolean}} */
    const found = { strokes: [], wiped: false };
    const newest_s = this.poses.at(-1)?.time ?? 0;
    let [taken, seen] = [0, 0];
    for (const pose of this.poses) {
      while ((this.colors[seen]?.time ?? Number.POSITIVE_INFINITY) < pose.time + LATER_S) seen += 1;
      if (seen === this.colors.length && newest_s - pose.time < PATIENCE_S) break;
      const color = (this.colors[seen] ?? this.colors.at(-1))?.color ?? unseen;
      this.step(pose, color, isBare(color), found);
      taken += 1;
    }
    this.poses.splice(0, taken);
    this.colors.splice(0, Math.min(seen, this.colors.length - 1));
    return found;
  }

  /** @param {Placed} pose @param {number} color @param {boolean} bare @param {{strokes: Stroke[], wiped: boolean}} found */
  step(pose, color, bare, found) {
    const before = this.last && pose.time - this.last.time < GAP_S ? this.last : null;
    const isThere = this.last?.x === pose.x && this.last.y === pose.y;
    this.last = pose;
    if (isThere) this.stand(pose.time, bare, found);
    else if (before) this.move(before, pose, color, bare, found);
    if (!isThere) [this.stoodSince_s, this.isOnLine] = [pose.time, false];
  }

  /** @param {number} time_s @param {boolean} bare @param {{wiped: boolean}} found */
  stand(time_s, bare, found) {
    if (time_s - this.stoodSince_s < STANDING_S) return;
    if (this.isOnLine && bare) found.wiped = true;
    this.isOnLine = !bare;
  }

  /** @param {Placed} before @param {Placed} pose @param {number} color @param {boolean} bare @param {{strokes: Stroke[]}} found */
  move(before, pose, color, bare, found) {
    if (bare) return;
    const goesOn = this.drawn !== null && pose.time - this.drawn.time < BRIDGE_S;
    found.strokes.push({ from: (goesOn && this.drawn) || before, to: pose, color });
    this.drawn = pose;
  }
}
