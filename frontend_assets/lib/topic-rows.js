/** Topics as rows of a table: which are noise, which match, and in which order they stand. */

/** @import { TopicRate, TopicRow } from "../types/wire.d.ts" */

import { includesAll } from "./live-displays.js";

/** @typedef {"name" | "type" | "rate" | "band"} TopicOrder */

const NOISE = new Set(["/rosout", "/parameter_events"]);

/** @param {string} name @returns {boolean} every node has it, or its name says that it is hidden */
export const isNoise = (name) => NOISE.has(name) || /\/_/.test(name);

/** @param {readonly string[]} types @returns {string} as short as it tells them apart */
export const shortTypes = (types) => types.map((one) => one.replace("/msg/", "/")).join(", ");

/**
 * @param {readonly TopicRow[]} topics
 * @param {{words: string, noise: boolean, order: TopicOrder, rates: ReadonlyMap<string, TopicRate>}} wished
 * @returns {TopicRow[]}
 */
export function shownTopics(topics, { words, noise, order, rates }) {
  const found = topics.filter(
    ({ name, types }) =>
      (noise || !isNoise(name)) && includesAll([name, ...types].join(" "), words),
  );
  return found.sort((a, b) => compared(a, b, order, rates) || a.name.localeCompare(b.name));
}

/** @param {TopicRow} a @param {TopicRow} b @param {TopicOrder} order @param {ReadonlyMap<string, TopicRate>} rates @returns {number} */
function compared(a, b, order, rates) {
  if (order === "type") return (a.types[0] ?? "").localeCompare(b.types[0] ?? "");
  if (order === "name") return 0;
  const value = (/** @type {TopicRow} */ { name }) => {
    const rate = rates.get(name);
    return (order === "rate" ? rate?.rate_hz : rate?.bytes_per_s) ?? 0;
  };
  return value(b) - value(a);
}
