/** What the files of a robot hold, as lists for a panel. */

/** @import { Outline, OutlineFile, OutlineMacro, OutlineValue } from "../types/wire.d.ts" */

/**
 * @typedef {object} FileRow a file where it is included
 * @property {string} id
 * @property {OutlineFile} file
 * @property {number} level from 1
 * @property {boolean} expandable
 * @property {boolean} expanded
 */

/**
 * @param {readonly OutlineFile[]} files each below the one whose number is its `inside`
 * @param {ReadonlySet<string>} closed ids whose files are hidden
 * @param {string} filter empty shows all; else files whose name matches and the way to them
 * @returns {FileRow[]} in the order in which they are shown
 */
export function fileRows(files, closed, filter) {
  const below = /** @type {number[][]} */ (files.map(() => []));
  files.forEach(({ inside }, at) => {
    if (inside >= 0 && inside !== at) below[inside]?.push(at);
  });
  const wanted = filter.trim().toLowerCase();
  const shown = wanted === "" ? null : wayTo(files, wanted);
  /** @type {FileRow[]} */
  const rows = [];
  /** @param {number} at @param {number} level */
  const add = (at, level) => {
    const file = files[at];
    if (!file || (shown && !shown.has(at))) return;
    const id = `${at}`;
    const inside = below[at] ?? [];
    const expanded = inside.length > 0 && (shown !== null || !closed.has(id));
    rows.push({ id, file, level, expandable: inside.length > 0, expanded });
    if (expanded) for (const one of inside) add(one, level + 1);
  };
  files.forEach(({ inside }, at) => {
    if (inside < 0) add(at, 1);
  });
  return rows;
}

/** @param {readonly OutlineFile[]} files @param {string} wanted lower case @returns {Set<number>} those that match, and what includes them */
function wayTo(files, wanted) {
  /** @type {Set<number>} */
  const found = new Set();
  files.forEach(({ file }, start) => {
    const name = file.slice(file.lastIndexOf("/") + 1).toLowerCase();
    if (!name.includes(wanted)) return;
    for (let at = start; at >= 0 && !found.has(at); at = files[at]?.inside ?? -1) found.add(at);
  });
  return found;
}

/** @param {Outline} outline @param {string} filter @returns {OutlineMacro[]} by name; all words of the filter are in name, documentation or parameters */
export function macrosOf({ macros }, filter) {
  const words = wordsOf(filter);
  const found = macros.filter(({ name, doc, parameters }) =>
    holds(`${name} ${doc} ${parameters.map((one) => one.name).join(" ")}`, words),
  );
  return found.sort((a, b) => a.name.localeCompare(b.name));
}

/** @param {Outline} outline @param {string} filter @returns {OutlineValue[]} args first, each by name */
export function valuesOf({ values }, filter) {
  const words = wordsOf(filter);
  const found = values.filter(({ name, doc }) => holds(`${name} ${doc}`, words));
  return found.sort((a, b) => a.kind.localeCompare(b.kind) || a.name.localeCompare(b.name));
}

/** @param {string} filter */
const wordsOf = (filter) => filter.toLowerCase().split(/\s+/).filter(Boolean);

/** @param {string} text @param {readonly string[]} words lower case */
function holds(text, words) {
  const low = text.toLowerCase();
  return words.every((word) => low.includes(word));
}

/**
 * @param {Pick<OutlineMacro, "name" | "parameters">} macro
 * @returns {{text: string, stops: [number, number][]}} a call with what it must give, and where that is typed
 */
export function callOf({ name, parameters }) {
  let text = `<xacro:${name}`;
  /** @type {[number, number][]} */
  const stops = [];
  const stop = () => stops.push([text.length, text.length]);
  for (const one of parameters) {
    if (one.kind !== "value" || one.default !== null || one.forwards) continue;
    text += ` ${one.name}="`;
    stop();
    text += '"';
  }
  if (parameters.every(({ kind }) => kind === "value")) return { text: `${text}/>`, stops };
  text += ">";
  stop();
  return { text: `${text}</xacro:${name}>`, stops };
}
