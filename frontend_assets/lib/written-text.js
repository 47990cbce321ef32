/** A text that stands in quotes in a file: where, and how another is written in its place. */

/** @type {Record<string, string>} */
const ESCAPES = {
  "&": "&amp;",
  "<": "&lt;",
  '"': "&quot;",
  "'": "&apos;",
  "\n": "&#10;",
  "\t": "&#9;",
};

/**
 * @param {string} text with LF at the end of each line
 * @param {{line: number, column: number}} place from 1, in characters
 * @returns {number} UTF-16 offset, -1 when there is no such place
 */
export function offsetAt(text, { line, column }) {
  let start = 0;
  for (let n = 1; n < line; n += 1) {
    start = text.indexOf("\n", start) + 1;
    if (start === 0) return -1;
  }
  const end = text.indexOf("\n", start);
  const characters = [...text.slice(start, end < 0 ? text.length : end)];
  if (column < 1 || column > characters.length + 1) return -1;
  return start + characters.slice(0, column - 1).join("").length;
}

/**
 * @param {string} file the whole text
 * @param {{line: number, column: number}} place where the attribute's text begins
 * @param {string} old what must stand there
 * @param {string} text that takes its place
 * @returns {{start: number, end: number, text: string} | null} null: something else stands there by now
 */
export function replacement(file, place, old, text) {
  const start = offsetAt(file, place);
  const quote = file[start - 1] ?? "";
  if (start < 1 || (quote !== '"' && quote !== "'")) return null;
  const end = file.indexOf(quote, start);
  if (end < 0 || plain(file.slice(start, end)) !== old) return null;
  return { start, end, text: escaped(text, quote) };
}

/** @param {string} text @param {string} quote around it @returns {string} */
function escaped(text, quote) {
  return text.replace(/[&<"'\n\t]/g, (one) =>
    (one === '"' || one === "'") && one !== quote ? one : (ESCAPES[one] ?? one),
  );
}

/** @param {string} raw @returns {string} references resolved, as XML reads an attribute */
function plain(raw) {
  return raw
    .replace(/[\n\t]/g, " ")
    .replace(/&(?:#(\d+)|#x([\da-fA-F]+)|(\w+));/g, (whole, decimal, hex, name) => {
      if (decimal) return String.fromCodePoint(Number(decimal));
      if (hex) return String.fromCodePoint(Number.parseInt(hex, 16));
      return Object.entries(ESCAPES).find(([, one]) => one === `&${name};`)?.[0] ?? whole;
    });
}
