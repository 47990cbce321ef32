/**
 * Which lines of two texts differ, as an editor marks them at its edge, and which words of two
 * lines.
 */

const TABLE_LIMIT = 400_000;

/**
 * @typedef {{line: number, kind: "changed" | "added" | "removed"}} LineMark `line` from 1 in the text as it
 *   is; `removed`: lines are missing above it
 */

/** @param {readonly string[]} before @param {readonly string[]} now @returns {LineMark[]} in order, one a line */
export function changedLines(before, now) {
  const { start, old, fresh } = middles(before, now);
  const kept = keptPairs(old, fresh);
  /** @type {LineMark[]} */
  const marks = [];
  let [from, to] = [0, 0];
  for (const [there, here] of [
    ...kept,
    /** @type {[number, number]} */ ([old.length, fresh.length]),
  ]) {
    marks.push(...marksOf(there - from, here - to, start + to + 1));
    [from, to] = [there + 1, here + 1];
  }
  return marks.map((mark) => ({ ...mark, line: Math.min(mark.line, Math.max(now.length, 1)) }));
}

/**
 * @typedef {object} Hunk lines, from 1; each end is behind the last
 * @property {number} from
 * @property {number} to in the text as it is
 * @property {number} oldFrom
 * @property {number} oldTo in the text as it was
 */

/**
 * @param {readonly string[]} before
 * @param {readonly string[]} now
 * @param {number} line from 1 in the text as it is, one that `changedLines` names
 * @returns {Hunk | null} the whole stretch of changed lines that it belongs to
 */
export function hunkAt(before, now, line) {
  const hunks = hunksOf(before, now);
  return (
    hunks.find(({ from, to }) => line >= from && line < to) ??
    hunks.find(({ from, to }) => from === to && Math.min(from, Math.max(now.length, 1)) === line) ??
    null
  );
}

/** @param {readonly string[]} before @param {readonly string[]} now @returns {Hunk[]} */
function hunksOf(before, now) {
  const { start, old, fresh } = middles(before, now);
  /** @type {Hunk[]} */
  const hunks = [];
  let [oldAt, at] = [0, 0];
  for (const [there, here] of [...keptPairs(old, fresh), [old.length, fresh.length]]) {
    const [oldTo, to] = [there ?? 0, here ?? 0];
    if (oldTo > oldAt || to > at)
      hunks.push({
        from: start + at + 1,
        to: start + to + 1,
        oldFrom: start + oldAt + 1,
        oldTo: start + oldTo + 1,
      });
    [oldAt, at] = [oldTo + 1, to + 1];
  }
  return hunks;
}

/** @param {readonly string[]} before @param {readonly string[]} now what lies between the lines that both begin and end with */
function middles(before, now) {
  const shorter = Math.min(before.length, now.length);
  let start = 0;
  while (start < shorter && before[start] === now[start]) start += 1;
  let end = 0;
  while (end < shorter - start && before.at(-1 - end) === now.at(-1 - end)) end += 1;
  const old = before.slice(start, before.length - end);
  return { start, old, fresh: now.slice(start, now.length - end) };
}

/** @param {string} before @param {string} now @returns {{from: number, to: number, insert: string}} the one change that makes it so */
export function oneChange(before, now) {
  const shorter = Math.min(before.length, now.length);
  let from = 0;
  while (from < shorter && before[from] === now[from]) from += 1;
  let end = 0;
  while (end < shorter - from && before.at(-1 - end) === now.at(-1 - end)) end += 1;
  return { from, to: before.length - end, insert: now.slice(from, now.length - end) };
}

/** @param {number} gone lines that stood there @param {number} came @param {number} line the first @returns {LineMark[]} */
function marksOf(gone, came, line) {
  if (came === 0) return gone > 0 ? [{ line, kind: "removed" }] : [];
  return Array.from({ length: came }, (_, at) => ({
    line: line + at,
    kind: at < gone ? "changed" : "added",
  }));
}

/**
 * The longest row of lines that stayed, as pairs of places; of two large stretches only what stands at
 * the same place in both, for the table would grow too large.
 *
 * @param {string[]} old
 * @param {string[]} fresh
 * @returns {[number, number][]}
 */
function keptPairs(old, fresh) {
  if (old.length * fresh.length > TABLE_LIMIT) return samePlaces(old, fresh);
  const width = fresh.length + 1;
  const table = new Uint32Array((old.length + 1) * width);
  for (let i = old.length - 1; i >= 0; i -= 1)
    for (let j = fresh.length - 1; j >= 0; j -= 1)
      table[i * width + j] =
        old[i] === fresh[j]
          ? (table[(i + 1) * width + j + 1] ?? 0) + 1
          : Math.max(table[(i + 1) * width + j] ?? 0, table[i * width + j + 1] ?? 0);
  return walk(old, fresh, table, width);
}

/** @param {string[]} old @param {string[]} fresh @param {Uint32Array} table @param {number} width @returns {[number, number][]} */
function walk(old, fresh, table, width) {
  /** @type {[number, number][]} */
  const pairs = [];
  let [i, j] = [0, 0];
  while (i < old.length && j < fresh.length) {
    if (old[i] === fresh[j]) {
      pairs.push([i, j]);
      i += 1;
      j += 1;
    } else if ((table[(i + 1) * width + j] ?? 0) >= (table[i * width + j + 1] ?? 0)) i += 1;
    else j += 1;
  }
  return pairs;
}

/** @param {string[]} old @param {string[]} fresh @returns {[number, number][]} */
function samePlaces(old, fresh) {
  if (old.length !== fresh.length) return [];
  return old.flatMap((line, at) => (line === fresh[at] ? [[at, at]] : []));
}

const WORDS = /[\p{L}\p{N}_.]+|\s+|./gu;
const WORD_TABLE_LIMIT = 40_000;

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
  if (old.length * fresh.length > WORD_TABLE_LIMIT) return kept;
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
