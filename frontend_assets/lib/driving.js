/** What hands do at a stick, at buttons and at keys, as the speed of a robot. */

import { clamp } from "./numbers.js";

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
