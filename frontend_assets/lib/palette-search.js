/** What a person typed into the palette: which kinds are asked for, which words, and which line. */

/** @import { Rank, Ranked } from "./ranking.js" */

import { ranked } from "./ranking.js";

/** Typed first, these signs ask for some kinds only. @type {Record<string, readonly Rank[]>} */
export const SIGNS = {
  ">": ["command", "panel"],
  "@": ["link", "joint"],
  "#": ["property", "literal"],
  "/": ["file"],
  "!": ["problem"],
};

/** @typedef {{kinds: readonly Rank[] | null, words: string, line: number, column: number}} Search `line`: 0 if none was asked for */

/** @param {string} text @returns {Search} */
export function readSearch(text) {
  const trimmed = text.trimStart();
  const kinds = SIGNS[trimmed[0] ?? ""] ?? null;
  const rest = kinds ? trimmed.slice(1) : trimmed;
  const place = /^(.*?):(\d{1,9})(?::(\d{1,9}))?\s*$/.exec(rest);
  const [, words = rest, line = "0", column = "1"] = place ?? [];
  return { kinds, words: words.trim(), line: Number(line), column: Number(column) };
}

/**
 * @template {Ranked} T
 * @typedef {{heading: string, choices: T[], more: number}} Section `more`: so many fit, too
 */

/**
 * @template {Ranked} T
 * @param {readonly T[]} found in order
 * @param {number} most of each kind
 * @returns {Section<T>[]} one for each kind, that of the best first
 */
export function sectionsOf(found, most) {
  /** @type {Map<string, T[]>} */
  const kinds = new Map();
  for (const one of found) {
    const those = kinds.get(one.rank);
    if (those) those.push(one);
    else kinds.set(one.rank, [one]);
  }
  return [...kinds].map(([heading, all]) => ({
    heading,
    choices: all.slice(0, most),
    more: Math.max(all.length - most, 0),
  }));
}

/**
 * @template {Ranked} T
 * @param {readonly T[]} all
 * @param {Search} search
 * @returns {T[]}
 */
export function fitting(all, { kinds, words }) {
  return ranked(kinds ? all.filter(({ rank }) => kinds.includes(rank)) : all, words);
}
