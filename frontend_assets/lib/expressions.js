/** Texts of sites: which are expressions, and how what was typed is written into the file. */

import { parseNumber } from "./numbers.js";

/** @param {string} text @returns {boolean} xacro would compute something here */
export function isExpression(text) {
  return /\$[{(]/.test(text.replaceAll("$$", ""));
}

/**
 * @param {string} text
 * @returns {string} what stands inside, when the whole text is one `${...}`; else the text
 */
export function shownText(text) {
  const trimmed = text.trim();
  return trimmed.startsWith("${") && closing(trimmed, 1) === trimmed.length - 1
    ? trimmed.slice(2, -1)
    : text;
}

const NAMES_MAX = 20;

/**
 * @param {string} text that is being typed @param {readonly string[]} names @returns {string[]} the text with its last word completed, by name
 */
export function completions(text, names) {
  const word = /[A-Za-z_]\w*$/.exec(text)?.[0] ?? "";
  if (word === "") return [];
  const start = text.slice(0, text.length - word.length);
  return names
    .filter((name) => name !== word && name.toLowerCase().startsWith(word.toLowerCase()))
    .slice(0, NAMES_MAX)
    .map((name) => start + name);
}

/**
 * @param {string} text
 * @param {number} open index of a `{` or `(`
 * @returns {number} index of the bracket that closes it, -1 when none does
 */
function closing(text, open) {
  const opened = text[open];
  const closed = opened === "{" ? "}" : ")";
  let depth = 0;
  for (let at = open; at < text.length; at += 1) {
    if (text[at] === opened) depth += 1;
    if (text[at] === closed) depth -= 1;
    if (depth === 0) return at;
  }
  return -1;
}

/**
 * @param {string} typed what stands in the box
 * @param {boolean} wraps the site takes numbers and its file evaluates `${...}`
 * @returns {string} the text for the file: a bare expression gets its braces
 */
export function writtenText(typed, wraps) {
  const text = typed.trim();
  const stands = !wraps || text === "" || parseNumber(text) !== null || isExpression(text);
  return stands ? text : `\${${text}}`;
}

/**
 * @param {string} text
 * @returns {string[]} its parts between blanks; blanks inside `${...}` and `$(...)` do not part
 */
export function splitVector(text) {
  /** @type {string[]} */
  const parts = [];
  let part = "";
  let at = 0;
  while (at < text.length) {
    const end = at + unitLength(text, at);
    const unit = text.slice(at, end);
    at = end;
    if (/\S/.test(unit)) part += unit;
    else if (part) {
      parts.push(part);
      part = "";
    }
  }
  return part ? [...parts, part] : parts;
}

/** @param {string} text @param {number} at @returns {number} characters of the expression there, else 1 */
function unitLength(text, at) {
  if (text[at] !== "$" || !/[{(]/.test(text[at + 1] ?? "")) return 1;
  const end = closing(text, at + 1);
  return end > 0 ? end - at + 1 : 1;
}

/** @param {string} text what was typed, `name:=value name2:=value2` @returns {Record<string, string>} */
export function parseArguments(text) {
  const pairs = text.match(/[^\s"']*(?:"[^"]*"|'[^']*'|[^\s"']+)+/g) ?? [];
  return Object.fromEntries(
    pairs
      .filter((pair) => pair.includes(":="))
      .map((pair) => {
        const [name = "", ...rest] = pair.split(":=");
        return [name, rest.join(":=").replace(/^(["'])(.*)\1$/, "$2")];
      }),
  );
}
