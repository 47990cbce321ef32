/**
 * Jerry's flat world: robots like him in the ROS 2 system, where a command leads, how far things
 * are, and his walk as this page has received it.
 */

/** @import { OfferView, TopicRow } from "../../types/wire.d.ts" */

import { signal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { askOrKeepWhy } from "../../model/asking.js";
import { echo, trace } from "../../model/data-lane.js";
import { called, inNamespaces, keptFor } from "../demo-panel.js";

/**
 * @typedef {{x: number, y: number}} Place metres; x points ahead and y to the left
 * @typedef {{name: string, type: string}} Topic
 * @typedef {{prefix: string, command: Topic | null, pose: Topic | null, distance: {name: string, type: string} | null}} Jerry
 *   `prefix`: the namespace, as "" or "/left"; null: nobody has it
 * @typedef {{direction: string, steps: number}} Command
 */

const COMMAND = /\/msg\/JerryCommand$/;
const POSE = /^geometry_msgs\/msg\/(Point|Pose2D)$/;
const POSE_NAME = "/jerry/pose";
const DISTANCE = /\/srv\/Distance$/;

/** Where one step leads. @type {Readonly<Record<string, Readonly<Place>>>} */
const STEPS = {
  forward: { x: 1, y: 0 },
  backward: { x: -1, y: 0 },
  left: { x: 0, y: 1 },
  right: { x: 0, y: -1 },
};
export const DIRECTIONS = Object.keys(STEPS);

/**
 * @param {readonly TopicRow[]} topics
 * @param {readonly OfferView[]} services
 * @returns {Jerry[]} by their namespaces
 */
export function jerriesOf(topics, services) {
  /** @type {Map<string, Jerry>} */
  const found = new Map();
  const at = (/** @type {string} */ name, /** @type {number} */ levels) => {
    const prefix = name.split("/").slice(0, -levels).join("/");
    const jerry = found.get(prefix) ?? { prefix, command: null, pose: null, distance: null };
    found.set(prefix, jerry);
    return jerry;
  };
  for (const { name, types, publishers } of topics) {
    const [command, pose] = [COMMAND, POSE].map((kind) => types.find((one) => kind.test(one)));
    if (command) at(name, 1).command ??= { name, type: command };
    if (pose && name.endsWith(POSE_NAME) && publishers > 0) at(name, 2).pose = { name, type: pose };
  }
  for (const { name, types } of services) {
    const type = types.find((one) => DISTANCE.test(one));
    if (type) at(name, 1).distance ??= { name, type };
  }
  return [...found.values()].sort((a, b) => (a.prefix < b.prefix ? -1 : 1));
}

/** @param {Command} command @returns {Place | null} by how much he moves; null: he does not know that and stays */
export function moveOf({ direction, steps }) {
  const step = Object.hasOwn(STEPS, direction) ? STEPS[direction] : undefined;
  if (!step || !Number.isInteger(steps) || steps < 0) return null;
  return { x: step.x * steps + 0, y: step.y * steps + 0 };
}

/** Two of them that differ by less are the same: both come out of roundings. */
const SAME = 1e-9;

/** @param {number} a @param {number} b */
export const isSame = (a, b) => Math.abs(a - b) <= SAME * Math.max(1, Math.abs(a), Math.abs(b));

/** @param {Place} from @param {Place} to @returns {number} m, as the crow flies */
export const distanceOf = (from, to) => Math.sqrt((to.x - from.x) ** 2 + (to.y - from.y) ** 2);

/** @param {number} value m @returns {string} so that it can be read, and a minus is one */
const short = (value) => String(Number(value.toFixed(3)) + 0).replace("-", "−");

/** @param {Place} place @returns {string} `(3, −2)` */
export const placeText = ({ x, y }) => `(${short(x)}, ${short(y)})`;

/** @param {Place} from @param {Place} to @returns {string} how the distance is worked out, in numbers */
export function formulaText(from, to) {
  const part = (/** @type {number} */ end, /** @type {number} */ begin) =>
    `(${short(end)} − ${begin < 0 ? `(${short(begin)})` : short(begin)})²`;
  return `√(${part(to.x, from.x)} + ${part(to.y, from.y)})`;
}

/** @typedef {{low: Place, size: number, step: number}} View a square of the world: its least corner, m, and how far lines are apart */

const SIDE_MIN = 12;
const LINES_MAX = 16;

/** @param {readonly Place[]} places @returns {View} in which all of them are, with room around them */
export function viewOf(places) {
  const all = [{ x: 0, y: 0 }, ...places];
  const range = (/** @type {"x" | "y"} */ axis) => {
    const values = all.map((one) => one[axis]);
    return [Math.min(...values), Math.max(...values)];
  };
  const [[lowX = 0, highX = 0], [lowY = 0, highY = 0]] = [range("x"), range("y")];
  const isNear = [lowX, highX, lowY, highY].every((end) => Math.abs(end) <= SIDE_MIN / 2 - 1);
  // It stands still while he walks about in its middle.
  if (isNear) return { low: { x: -SIDE_MIN / 2, y: -SIDE_MIN / 2 }, size: SIDE_MIN, step: 1 };
  const size = Math.max(SIDE_MIN, (Math.max(highX - lowX, highY - lowY) + 2) * 1.1);
  const low = { x: (lowX + highX - size) / 2, y: (lowY + highY - size) / 2 };
  return { low, size, step: gridStep(size) };
}

/** @param {number} size m @returns {number} 1, 2 or 5 times a power of ten, at least 1 */
function gridStep(size) {
  const least = Math.max(1, size / LINES_MAX);
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((times) => times * power >= least) ?? 10);
}

/** @param {number} low @param {number} size @param {number} step @returns {number[]} the lines of a grid, m */
export function gridLines(low, size, step) {
  const first = Math.ceil(low / step);
  const count = Math.floor((low + size) / step) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, n) => (first + n) * step + 0);
}

/**
 * @typedef {"pending" | "followed" | "ignored" | "unknown"} Fate
 *   `ignored`: his place did not change by it; `unknown`: he is not to follow it
 * @typedef {Command & {number: number, heard_s: number, fate: Fate}} Heard
 */

const WAY_MAX = 1000;
const COMMANDS_MAX = 40;
/** He has so long to tell where a command led him. */
const PATIENCE_S = 2;

export class Walk {
  constructor() {
    /** The oldest first. @type {Place[]} */
    this.way = [];
    /** The newest first. @type {Heard[]} */
    this.commands = [];
    /** Steps that no command was heard for as yet. @type {(Place & {seen_s: number})[]} */
    this.steps = [];
    this.count = 0;
  }

  /** @returns {Place | null} null: he has not told */
  get place() {
    return this.way.at(-1) ?? null;
  }

  /** @param {Place} place that he told @param {number} now_s */
  stand({ x, y }, now_s) {
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    const before = this.place;
    if (before && before.x === x && before.y === y) return;
    this.way.push({ x, y });
    if (this.way.length > WAY_MAX) this.way.shift();
    if (before) this.match({ x: x - before.x, y: y - before.y, seen_s: now_s });
  }

  /** @param {Place & {seen_s: number}} step */
  match(step) {
    // The oldest that fits: he takes them in turn.
    const led = this.commands.findLast((one) => one.fate === "pending" && leads(one, step));
    if (led) this.tell(led, "followed");
    else this.steps = [...this.steps.slice(1 - COMMANDS_MAX), step];
  }

  /** @param {Command} command @param {number} now_s */
  hear({ direction, steps }, now_s) {
    this.count += 1;
    const heard = { direction, steps, number: this.count, heard_s: now_s };
    this.commands = [
      { ...heard, fate: this.fateOf(heard, now_s) },
      ...this.commands.slice(0, COMMANDS_MAX - 1),
    ];
  }

  /** @param {Command} command @param {number} now_s @returns {Fate} what he told may have come before it */
  fateOf(command, now_s) {
    const move = moveOf(command);
    if (!move) return "unknown";
    if (move.x === 0 && move.y === 0) return "followed";
    const at = this.steps.findIndex(
      (step) => now_s - step.seen_s < PATIENCE_S && leads(command, step),
    );
    if (at < 0) return "pending";
    this.steps.splice(at, 1);
    return "followed";
  }

  /** @param {number} now_s @returns {boolean} whether something is given up now */
  expire(now_s) {
    const late = this.commands.filter(
      ({ fate, heard_s }) => fate === "pending" && now_s - heard_s > PATIENCE_S,
    );
    for (const one of late) this.tell(one, "ignored");
    return late.length > 0;
  }

  /** @param {Heard} command @param {Fate} fate */
  tell(command, fate) {
    this.commands = this.commands.map((one) => (one === command ? { ...one, fate } : one));
  }

  /** Forget the way that led here. */
  clear() {
    this.way = this.way.slice(-1);
    this.commands = [];
    this.steps = [];
  }
}

/** @param {Command} command @param {Place} step @returns {boolean} */
function leads(command, step) {
  const move = moveOf(command);
  return move !== null && isSame(move.x, step.x) && isSame(move.y, step.y);
}

const WALKS_MAX = 8;
const RUNS_MAX = 20;
const EXPIRE_MS = 500;

export const jerries = inNamespaces(jerriesOf);
/** Why what was asked for last was not done; empty: it was. */
export const jerryTrouble = signal("");

/**
 * @typedef {{number: number, place: Place, from: Place, answer: number, right: number, isExact: boolean}} Run
 *   how far a place is: from where he stood, what he answered, and what is right
 * @typedef {{walk: Walk, runs: readonly Run[], newest_s: number, turn: import("vendor/preact.js").Signal<number>}} Seen
 *   `newest_s`: when the last command came, by the studio's clock; `turn` changes whenever something does
 */

/** @returns {Seen} */
const nothing = () => ({ walk: new Walk(), runs: [], newest_s: 0, turn: signal(0) });

/** What was seen of a Jerry so far, by his namespace. */
export const seenOf = keptFor(nothing, WALKS_MAX);

const now_s = () => performance.now() / 1000;

/** @param {Jerry["pose"]} pose @param {Seen} known @returns {() => void} the end of hearing where he is */
export function hearPlaces(pose, { walk, turn }) {
  if (!pose) return () => {};
  /** @param {{values: Float64Array[]}} points */
  const onPoints = ({ values: [x, y] }) => {
    x?.forEach((value, n) => {
      walk.stand({ x: value, y: y?.[n] ?? Number.NaN }, now_s());
    });
    turn.value += 1;
  };
  const tracer = { onState: () => {}, onPoints };
  return trace(pose.name, [".x", ".y"], { typeName: pose.type }, tracer).leave;
}

/** @param {Jerry["command"]} command @param {Seen} known @returns {() => void} the end of hearing what he is told */
export function hearCommands(command, known) {
  if (!command) return () => {};
  const { walk, turn } = known;
  /** @param {{value: any, received_s: number}} message */
  const onMessage = ({ value, received_s }) => {
    // Who looks anew is shown the last one again.
    if (received_s <= known.newest_s) return;
    if (typeof value?.direction !== "string" || typeof value.steps !== "number") return;
    known.newest_s = received_s;
    walk.hear(value, now_s());
    turn.value += 1;
  };
  const ways = { typeName: command.type, mostHz: 60 };
  const echoed = echo(command.name, ways, { onState: () => {}, onMessage });
  const timer = setInterval(() => {
    if (walk.expire(now_s())) turn.value += 1;
  }, EXPIRE_MS);
  return () => {
    clearInterval(timer);
    echoed.leave();
  };
}

/** @param {Seen} known */
export function clearWalk(known) {
  known.walk.clear();
  known.runs = [];
  known.turn.value += 1;
}

/** @param {Jerry} jerry @param {string} direction @param {number} steps */
export async function command({ command }, direction, steps) {
  if (!command) return;
  await askOrKeepWhy(
    {
      ...{ type: "publish", name: command.name, message_type: command.type },
      ...{ text: JSON.stringify({ direction, steps }), rate_hz: 0 },
      ...{ reliable: true, latched: false, depth: 10 },
    },
    jerryTrouble,
  );
}

/** @param {Jerry} jerry @param {Seen} known @param {Place} place ask how far it is */
export async function measure({ distance }, known, place) {
  if (!distance) return;
  const begin = Math.max(0, known.walk.way.length - 1);
  const { reply, trouble } = await called(distance, { x: place.x, y: place.y });
  jerryTrouble.value = trouble;
  // He may have gone on while he was asked: each place of that time is right.
  const stood = known.walk.way.slice(begin);
  if (typeof reply?.distance !== "number" || stood.length === 0) {
    jerryTrouble.value ||= t("jerry.no_place");
    return;
  }
  const { distance: answer } = reply;
  const from = stood.find((one) => isSame(distanceOf(one, place), answer)) ?? stood.at(-1);
  if (from) keepRun(known, { place, from, answer });
}

/** @param {Seen} known @param {{place: Place, from: Place, answer: number}} run */
function keepRun(known, { place, from, answer }) {
  const right = distanceOf(from, place);
  const number = (known.runs[0]?.number ?? 0) + 1;
  const run = { number, place, from, answer, right, isExact: isSame(right, answer) };
  known.runs = [run, ...known.runs.slice(0, RUNS_MAX - 1)];
  known.turn.value += 1;
}
