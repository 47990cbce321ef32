/** Which characters of a line differ from those of another line: in whole words, as people read. */

const WORDS = /[\p{L}\p{N}_.]+|\s+|./gu;
const TABLE_LIMIT = 40_000;

/** @typedef {{text: string, marked: boolean}} Piece */

/**
 * @param {string} before
 * @param {string} now
 * @returns {{before: Piece[], now: Piece[]}} each text in pieces; what the other one has not is marked
 */
export function markedTexts(before, now) {
  const [old, fresh] = [before.match(WORDS) ?? [], now.match(WORDS) ?? []];
  const shorter = Math.min(old.length, fresh.length);
  let start = 0;
  while (start < shorter && old[start] === fresh[start]) start += 1;
  let end = 0;
  while (end < shorter - start && old.at(-1 - end) === fresh.at(-1 - end)) end += 1;
  const middle = [old.slice(start, old.length - end), fresh.slice(start, fresh.length - end)];
  const [oldKept, freshKept] = keptWords(middle[0] ?? [], middle[1] ?? []);
  return {
    before: pieces(old, (at) => isKept(at, start, old.length - end, oldKept)),
    now: pieces(fresh, (at) => isKept(at, start, fresh.length - end, freshKept)),
  };
}

/** @param {number} at @param {number} start @param {number} end @param {ReadonlySet<number>} kept */
const isKept = (at, start, end, kept) => at < start || at >= end || kept.has(at - start);

/** @param {string[]} words @param {(at: number) => boolean} kept @returns {Piece[]} */
function pieces(words, kept) {
  /** @type {Piece[]} */
  const made = [];
  words.forEach((word, at) => {
    const marked = !kept(at);
    const last = made.at(-1);
    if (last?.marked === marked) last.text += word;
    else made.push({ text: word, marked });
  });
  return made;
}

/** The longest row of words that both have, by their places. @param {string[]} old @param {string[]} fresh @returns {[Set<number>, Set<number>]} */
function keptWords(old, fresh) {
  /** @type {[Set<number>, Set<number>]} */
  const kept = [new Set(), new Set()];
  if (old.length * fresh.length > TABLE_LIMIT) return kept;
  const left = rowsLeft(old, fresh);
  let [i, j] = [0, 0];
  while (i < old.length && j < fresh.length) {
    if (old[i] === fresh[j]) {
      kept[0].add(i);
      kept[1].add(j);
      i += 1;
      j += 1;
    } else if (left(i + 1, j) >= left(i, j + 1)) i += 1;
    else j += 1;
  }
  return kept;
}

/** @param {string[]} old @param {string[]} fresh @returns {(i: number, j: number) => number} the longest common row behind two places */
function rowsLeft(old, fresh) {
  const width = fresh.length + 1;
  const table = new Uint16Array((old.length + 1) * width);
  const left = (/** @type {number} */ i, /** @type {number} */ j) => table[i * width + j] ?? 0;
  for (let i = old.length - 1; i >= 0; i -= 1)
    for (let j = fresh.length - 1; j >= 0; j -= 1)
      table[i * width + j] =
        old[i] === fresh[j] ? left(i + 1, j + 1) + 1 : Math.max(left(i + 1, j), left(i, j + 1));
  return left;
}

/**
 * @typedef {import("../types/wire.d.ts").DiffLineView} Line
 * @typedef {Line & {pieces: Piece[]}} DrawnLine
 */

/** Lines in their order, those that replace each other compared. @param {readonly Line[]} lines @returns {DrawnLine[]} */
export function drawnLines(lines) {
  /** @type {DrawnLine[]} */
  const drawn = [];
  let at = 0;
  while (at < lines.length) {
    const old = stretch(lines, at, "old");
    const fresh = stretch(lines, at + old.length, "new");
    if (old.length + fresh.length === 0) {
      drawn.push(...stretch(lines, at, "same").map((line) => plain(line)));
      at = drawn.length;
      continue;
    }
    const pairs = old.map((line, n) => markedTexts(line.text, fresh[n]?.text ?? line.text));
    drawn.push(...old.map((line, n) => ({ ...line, pieces: pairs[n]?.before ?? [] })));
    drawn.push(
      ...fresh.map((line, n) => {
        const pair = pairs[n];
        return pair ? { ...line, pieces: pair.now } : plain(line);
      }),
    );
    at = drawn.length;
  }
  return drawn;
}

/** @param {Line} line @returns {DrawnLine} */
const plain = (line) => ({ ...line, pieces: [{ text: line.text, marked: false }] });

/** @param {readonly Line[]} lines @param {number} start @param {Line["kind"]} kind @returns {Line[]} */
function stretch(lines, start, kind) {
  let end = start;
  while (lines[end]?.kind === kind) end += 1;
  return lines.slice(start, end);
}
