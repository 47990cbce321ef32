/** Deeds as the studio tells them: those that changed are put in the place of what was known. */

/** @import { OfferView } from "../types/wire.d.ts" */

/** @typedef {{deed: number, feedback?: readonly {number: number}[]}} Deed */

const KEPT = 80;
const FEEDBACK_KEPT = 50;
/** Services that every node has, and the parts of actions. */
const NOISE =
  /\/_|\/(get_parameters|get_parameter_types|set_parameters|set_parameters_atomically|describe_parameters|list_parameters|get_type_description|get_logger_levels|set_logger_levels)$/;

/**
 * @template {Deed} T
 * @param {readonly T[]} known
 * @param {{whole: boolean, deeds: readonly T[]}} news
 * @returns {readonly T[]} by their numbers, the newest last
 */
export function withDeeds(known, { whole, deeds }) {
  if (whole) return deeds;
  const byNumber = new Map(known.map((one) => [one.deed, one]));
  for (const one of deeds) byNumber.set(one.deed, merged(byNumber.get(one.deed), one));
  return [...byNumber.values()].sort((a, b) => a.deed - b.deed).slice(-KEPT);
}

/**
 * @template {Deed} T
 * @param {T | undefined} before @param {T} now whose feedback is only what is new
 * @returns {T}
 */
function merged(before, now) {
  if (!now.feedback) return now;
  const first = now.feedback[0]?.number ?? Number.POSITIVE_INFINITY;
  const kept = (before?.feedback ?? []).filter(({ number }) => number < first);
  return { ...now, feedback: [...kept, ...now.feedback].slice(-FEEDBACK_KEPT) };
}

/**
 * @param {readonly OfferView[]} offers
 * @param {string} filter words that are part of a name, a type or a node
 * @param {boolean} all also what every node serves
 */
export function matchingOffers(offers, filter, all) {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  return offers.filter(({ name, types, nodes }) => {
    if (!all && NOISE.test(name)) return false;
    const text = [name, ...types, ...nodes].join(" ").toLowerCase();
    return words.every((word) => text.includes(word));
  });
}

/** @param {number} seconds @returns {string} how long something took */
export function tookText(seconds) {
  if (seconds < 1) return `${Math.round(seconds * 1000)} ms`;
  return seconds < 100 ? `${seconds.toFixed(1)} s` : `${Math.round(seconds)} s`;
}

/** @param {string} json @returns {unknown} undefined: there is none */
export const plainOf = (json) => (json ? JSON.parse(json) : undefined);

const GOAL_OVER = new Set(["succeeded", "canceled", "aborted", "rejected", "failed"]);

/** @param {{state: string}} goal */
export const isGoalOver = ({ state }) => GOAL_OVER.has(state);

/**
 * @param {string} actionType @param {unknown} result
 * @returns {number | null} rad that turtlesim's turtle turned, to the left: its server tells them from the end back to the start
 */
export function turnedRad(actionType, result) {
  if (actionType !== "turtlesim/action/RotateAbsolute") return null;
  const delta = /** @type {{delta?: unknown} | undefined} */ (result)?.delta;
  return typeof delta === "number" ? -delta : null;
}

/** @param {unknown} value @returns {string} plain values on one line */
export function shortOf(value) {
  if (typeof value !== "object" || value === null) return String(value);
  if (Array.isArray(value)) return `[${value.map(shortOf).join(", ")}]`;
  const inner = Object.entries(value).map(([key, one]) => {
    const text = shortOf(one);
    return typeof one === "object" && one !== null && !Array.isArray(one)
      ? `${key}: {${text}}`
      : `${key}: ${text}`;
  });
  return inner.join(", ");
}
