/** Jerry, a robot in a flat world: where he is on the wire, where a command leads, and how far things are. */

/** @import { OfferView, TopicRow } from "../types/wire.d.ts" */
/** @import { Service } from "./turtles.js" */

/**
 * @typedef {{x: number, y: number}} Place metres; x points ahead and y to the left
 * @typedef {{name: string, type: string}} Topic
 * @typedef {{prefix: string, command: Topic | null, pose: Topic | null, distance: Service | null}} Jerry
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
