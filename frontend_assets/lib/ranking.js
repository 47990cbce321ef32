/** What fits the words of a search, in the order in which it is most likely meant. */

/** From the likeliest to what nobody names: numbers and texts without a name of their own. */
export const RANKS = /** @type {const} */ ([
  "command",
  "link",
  "variant",
  "property",
  "file",
  "literal",
]);

/** @typedef {{rank: typeof RANKS[number], label: string, words?: string}} Ranked `words`: also found by these */

/**
 * @template {Ranked} T
 * @param {readonly T[]} all
 * @param {string} text of the search
 * @returns {T[]} those in which every word occurs; unnamed ones last, those that begin with the first word before others
 */
export function ranked(all, text) {
  const words = text.trim().toLowerCase().split(/\s+/).filter(Boolean);
  const [first] = words;
  if (first === undefined) return [...all];
  const start = new RegExp(`(^|[\\s:_./])${first.replace(/[^\p{L}\p{N}_]/gu, "\\$&")}`, "iu");
  return all
    .map((one) => ({ one, heap: `${one.label} ${one.words ?? ""}`.toLowerCase() }))
    .filter(({ heap }) => words.every((word) => heap.includes(word)))
    .map(({ one, heap }) => ({ one, order: orderOf(one, start.test(heap)) }))
    .sort((a, b) => a.order - b.order)
    .map(({ one }) => one);
}

/** @param {Ranked} one @param {boolean} begins @returns {number} the smaller the earlier */
function orderOf({ rank }, begins) {
  const unnamed = rank === "literal" ? 2 : 0;
  return (unnamed + (begins ? 0 : 1)) * RANKS.length + RANKS.indexOf(rank);
}
