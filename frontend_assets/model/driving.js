/**
 * Driving a robot by hand: the topic, the limits, the speed that a stick, buttons or keys ask
 * for, which is sent again and again, and zero at once when they are let go.
 */

/** @import { TopicRow } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { computed, signal, useRef } from "vendor/preact.js";
import { clamp } from "../lib/numbers.js";
import { remembered } from "../lib/remembered.js";
import { askedWhenChanged, askOrKeepWhy } from "./asking.js";
import { mayAct } from "./connection.js";

/** @typedef {{x: number, y: number, turn: number}} Deflection each from -1 to 1: forward, to the left, anticlockwise */
/** @typedef {{linear: number, angular: number, sideways: boolean}} Limits m/s, rad/s; whether it can move to its left */

/** @type {Readonly<Deflection>} */
export const CENTRE = Object.freeze({ x: 0, y: 0, turn: 0 });
/** The middle of a stick: a hand does not rest on a point. */
const DEAD_SHARE = 0.08;

/** What each key does, by its place on the keyboard. @type {Readonly<Record<string, Partial<Deflection>>>} */
const KEYS = {
  ArrowUp: { x: 1 },
  KeyW: { x: 1 },
  ArrowDown: { x: -1 },
  KeyS: { x: -1 },
  ArrowLeft: { y: 1 },
  KeyA: { y: 1 },
  ArrowRight: { y: -1 },
  KeyD: { y: -1 },
  KeyQ: { turn: 1 },
  KeyE: { turn: -1 },
};

/** @param {string} code @returns {boolean} */
export const drives = (code) => Object.hasOwn(KEYS, code);

/**
 * @param {number} right of the middle, in px
 * @param {number} down
 * @param {number} radius px
 * @returns {Deflection}
 */
export function ofStick(right, down, radius) {
  const length = Math.hypot(right, down) / radius;
  if (!(length > DEAD_SHARE)) return CENTRE;
  const share = (Math.min(length, 1) - DEAD_SHARE) / (1 - DEAD_SHARE) / length / radius;
  return { x: -down * share, y: -right * share, turn: 0 };
}

/** @param {Iterable<string>} codes of the keys that are held @returns {Deflection} */
export const ofKeys = (codes) => together([...codes].map((code) => ({ ...CENTRE, ...KEYS[code] })));

/** @param {Iterable<Deflection>} held @returns {Deflection} of all hands, none further than a stick goes */
export function together(held) {
  const sum = { ...CENTRE };
  for (const one of held) {
    sum.x += one.x;
    sum.y += one.y;
    sum.turn += one.turn;
  }
  return { x: clamp(sum.x, -1, 1), y: clamp(sum.y, -1, 1), turn: clamp(sum.turn, -1, 1) };
}

/**
 * @param {Deflection} held
 * @param {Limits} limits
 * @returns {{x: number, y: number, yaw: number}} m/s, m/s and rad/s; what cannot move sideways turns instead
 */
export function speedOf(held, { linear, angular, sideways }) {
  const turn = sideways ? held.turn : clamp(held.turn + held.y, -1, 1);
  return {
    x: rounded(held.x * linear),
    y: sideways ? rounded(held.y * linear) : 0,
    yaw: rounded(turn * angular),
  };
}

/** @param {number} speed @returns {number} to a thousandth, and no -0 */
const rounded = (speed) => Math.round(speed * 1000) / 1000 + 0;

/**
 * @param {readonly {name: string, types: readonly string[], subscribers: number}[]} topics
 * @returns {{name: string, stamped: boolean}[]} those that take speeds, the ones that somebody hears first
 */
export function drivable(topics) {
  const found = topics.flatMap(({ name, types, subscribers }) => {
    const type = types.find((one) => one === TWIST || one === STAMPED);
    return type ? [{ name, stamped: type === STAMPED, heard: subscribers > 0 }] : [];
  });
  found.sort((a, b) => Number(b.heard) - Number(a.heard) || a.name.localeCompare(b.name));
  return found.map(({ name, stamped }) => ({ name, stamped }));
}

const TWIST = "geometry_msgs/msg/Twist";
const STAMPED = "geometry_msgs/msg/TwistStamped";

const ANYWAY = { name: "/cmd_vel", stamped: false };

/** @type {Signal<readonly TopicRow[]>} */
const topics = signal([]);
export const drivingRefused = signal("");
/** What a person wrote for the topic; null: the first that fits. @type {Signal<{name: string, stamped: boolean} | null>} */
export const chosenDrive = signal(null);
export const driveTopics = computed(() => drivable(topics.value));
/** Where speeds go. */
export const driveTarget = computed(() => chosenDrive.value ?? driveTopics.value[0] ?? ANYWAY);

/** @type {Signal<Limits & {rate: number}>} */
export const driveLimits = remembered(
  "teleop",
  { linear: 0.5, angular: 1, sideways: false, rate: 20 },
  isLimits,
);
/** What each hand holds, by where it does. @type {Signal<ReadonlyMap<string, Deflection>>} */
export const held = signal(new Map());

/** @param {unknown} stored @returns {boolean} */
function isLimits(stored) {
  if (typeof stored !== "object" || stored === null) return false;
  const { linear, angular, sideways, rate } = /** @type {Record<string, unknown>} */ (stored);
  return (
    [linear, angular, rate].every((one) => typeof one === "number" && one > 0 && one <= 100) &&
    typeof sideways === "boolean"
  );
}

async function askTopics() {
  const reply = await askOrKeepWhy({ type: "list_topics" }, signal(""));
  if (reply?.type === "topic_table") topics.value = reply.topics;
}
/** Know the topics that take speeds while somebody looks; gives the end of looking. */
export const followDrivable = askedWhenChanged(askTopics, "graph");

/** @typedef {{name: string, stamped: boolean, limits: () => Limits & {rate: number}}} DriveTarget a topic, and how fast what hears it may go */

/** @returns {DriveTarget} as the Teleop panel says */
const chosenTarget = () => ({ ...driveTarget.peek(), limits: () => driveLimits.peek() });

/** @type {ReturnType<typeof setTimeout> | undefined} while something is held */
let beat;
/** Where the robot is that moves now: another topic may be chosen meanwhile. */
let moved = chosenTarget();
let waits = false;

/** @param {string} hand @param {Deflection} deflection what this hand holds from now on @param {DriveTarget} [target] of what stood still until now */
export function hold(hand, deflection, target = chosenTarget()) {
  if (!mayAct.peek()) return;
  held.value = new Map(held.peek()).set(hand, deflection);
  if (beat !== undefined) return;
  moved = target;
  go();
}

/** @param {string} hand that lets go; what others hold counts on */
export function release(hand) {
  const left = new Map(held.peek());
  if (!left.delete(hand)) return;
  held.value = left;
  if (left.size === 0) halt();
}

/** Stand still now, whatever is held. */
export function halt() {
  held.value = new Map();
  if (beat === undefined) return;
  clearTimeout(beat);
  beat = undefined;
  say(CENTRE);
}

function go() {
  beat = setTimeout(go, 1000 / moved.limits().rate);
  // One at a time: on a slow line old speeds would pile up before the newest.
  if (!waits) say(together(held.peek().values()));
}

/** @param {Deflection} deflection */
async function say(deflection) {
  const { name: topic, stamped, limits } = moved;
  waits = true;
  const speed = speedOf(deflection, limits());
  const answer = await askOrKeepWhy({ type: "drive", topic, stamped, ...speed }, drivingRefused);
  waits = false;
  if (answer === null) giveUp();
}

/** It was refused, or the studio is gone, which stops the robot by itself. */
function giveUp() {
  clearTimeout(beat);
  beat = undefined;
  held.value = new Map();
}

const HAND = "keys";

/** @param {() => DriveTarget} [target] where speeds go; without one as the Teleop panel says @returns {{onKeyDown: (event: KeyboardEvent) => void, onKeyUp: (event: KeyboardEvent) => void, onFocusOut: (event: any) => void}} for the element around those parts */
export function useDrivingKeys(target) {
  const keys = useRef(/** @type {Set<string>} */ (new Set()));
  const letGo = () => {
    keys.current.clear();
    halt();
  };
  return {
    onKeyDown(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.code === "Space") letGo();
      else if (!drives(event.code)) return;
      else if (!event.repeat) hold(HAND, ofKeys(keys.current.add(event.code)), target?.());
      // Neither the page scrolls nor another part of it takes the key.
      event.preventDefault();
      event.stopPropagation();
    },
    onKeyUp(event) {
      if (!keys.current.delete(event.code)) return;
      if (keys.current.size > 0) hold(HAND, ofKeys(keys.current), target?.());
      else release(HAND);
    },
    onFocusOut(event) {
      if (!event.currentTarget.contains(event.relatedTarget)) letGo();
    },
  };
}
