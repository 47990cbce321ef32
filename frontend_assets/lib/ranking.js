/** What fits the words of a search, in the order in which it is most likely meant. */

/** From the likeliest to what nobody names: numbers and texts without a name of their own. */
export const RANKS = /** @type {const} */ ([
  "line",
  "command",
  "panel",
  "ros2",
  "lesson",
  "demo",
  "example",
  "link",
  "joint",
  "pose",
  "variant",
  "property",
  "file",
  "problem",
  "literal",
]);

/** @typedef {typeof RANKS[number]} Rank */
/** @typedef {{rank: Rank, label: string, words?: string}} Ranked `words`: also found by these */
/** @typedef {readonly [number, number]} Span from one character of a label up to another */

/** How a word was found: the smaller the better. */
const FIRST = 0;
const BEGINS = 1;
const INSIDE = 2;
const ELSEWHERE = 3;
const SCATTERED = 4;
/** Letters that stand further apart than this, times their number, are there by chance. */
const SPREAD = 3;
const SCATTERED_LEAST = 3;

/**
 * @template {Ranked} T
 * @param {readonly T[]} all
 * @param {string} text of the search
 * @returns {T[]} those in which every word occurs; unnamed ones last, those that begin with the words before others
 */
export function ranked(all, text) {
  const words = wordsOf(text);
  if (words.length === 0) return [...all];
  return all
    .flatMap((one) => {
      const how = fit(one, words);
      return how === null ? [] : [{ one, order: orderOf(one, how) }];
    })
    .sort((a, b) => a.order - b.order)
    .map(({ one }) => one);
}

/** @param {string} label @param {string} text of the search @returns {Span[]} what of the label the words are, in order */
export function marksOf(label, text) {
  const spans = wordsOf(text).flatMap((word) => spansOf(label.toLowerCase(), word)?.spans ?? []);
  return joined(spans.sort((a, b) => a[0] - b[0]));
}

/** @param {string} text @returns {string[]} */
const wordsOf = (text) => text.trim().toLowerCase().split(/\s+/).filter(Boolean);

/** @param {Ranked} one @param {string[]} words @returns {number | null} how badly it fits; null: not at all */
function fit({ label, words: more = "" }, words) {
  const [name, others] = [label.toLowerCase(), more.toLowerCase()];
  let sum = 0;
  for (const word of words) {
    const found = spansOf(name, word);
    const how = Math.min(found?.how ?? Infinity, others.includes(word) ? ELSEWHERE : Infinity);
    if (how === Infinity) return null;
    sum += how;
  }
  return sum / words.length;
}

/** @param {Ranked} one @param {number} how @returns {number} the smaller the earlier */
function orderOf({ rank, label }, how) {
  const unnamed = rank === "literal" ? SCATTERED + 1 : 0;
  // Of two names that fit alike the shorter one has less beside what was typed.
  return (unnamed + how) * RANKS.length + RANKS.indexOf(rank) + Math.min(label.length, 500) / 1000;
}

/** @param {string} name @param {string} word @returns {{how: number, spans: Span[]} | null} both in small letters */
function spansOf(name, word) {
  const start = startingWith(name, word);
  const how = start === 0 ? FIRST : BEGINS;
  if (start >= 0) return { how, spans: [[start, start + word.length]] };
  const inside = name.indexOf(word);
  if (inside >= 0) return { how: INSIDE, spans: [[inside, inside + word.length]] };
  const letters = word.length < SCATTERED_LEAST ? null : scattered(name, word);
  return letters && { how: SCATTERED, spans: letters.map((at) => [at, at + 1]) };
}

/** @param {string} name @param {string} word @returns {number} where it begins a part of the name, else -1 */
function startingWith(name, word) {
  let at = name.indexOf(word);
  while (at > 0 && !isStart(name, at)) at = name.indexOf(word, at + 1);
  return at;
}

/** @param {string} name @param {number} at @returns {boolean} */
const isStart = (name, at) => at === 0 || /[\s:_./-]/.test(name[at - 1] ?? "");

/** @param {string} name @param {string} word @returns {number[] | null} its letters in this order, from the start of some part */
function scattered(name, word) {
  /** @type {number[] | null} */
  let best = null;
  for (let from = 0; from < name.length; from += 1) {
    if (name[from] !== word[0] || !isStart(name, from)) continue;
    const letters = lettersFrom(name, word, from);
    if (letters && (!best || width(letters) < width(best))) best = letters;
  }
  return best && width(best) <= word.length * SPREAD ? best : null;
}

/** @param {number[]} letters @returns {number} */
const width = (letters) => (letters.at(-1) ?? 0) - (letters[0] ?? 0) + 1;

/** @param {string} name @param {string} word @param {number} from @returns {number[] | null} */
function lettersFrom(name, word, from) {
  const letters = [];
  let at = from;
  for (const letter of word) {
    at = name.indexOf(letter, at);
    if (at < 0) return null;
    letters.push(at);
    at += 1;
  }
  return letters;
}

/** @param {Span[]} spans in order @returns {Span[]} those that touch as one */
function joined(spans) {
  /** @type {[number, number][]} */
  const all = [];
  for (const [from, to] of spans) {
    const last = all.at(-1);
    if (last && from <= last[1]) last[1] = Math.max(last[1], to);
    else all.push([from, to]);
  }
  return all;
}
