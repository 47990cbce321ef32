/** Grounds of turtlesim and the turtles on them, told by the names and types of topics and services. */

/** @import { OfferView, TopicRow } from "../types/wire.d.ts" */

import { drivable } from "./driving.js";

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

/** @param {number} color 0xrrggbb @returns {string} as a page writes it */
export const hexOf = (color) => `#${color.toString(16).padStart(6, "0")}`;

/** @param {string} hex `#rrggbb` @returns {[number, number, number]} red, green and blue, 0 to 255 */
export function bytesOf(hex) {
  const color = Number.parseInt(hex.slice(1), 16);
  return [(color >> 16) & 255, (color >> 8) & 255, color & 255];
}
