/** Where in a text a problem is underlined. */

/** @import { Problem } from "../types/wire.d.ts" */

const WORD = /^(?:<\/?[\w:.-]+|[\w:.-]*\w|\$\{[^}]*\}?)/;

/**
 * @typedef {object} Lines a text by its lines
 * @property {number} lines
 * @property {(number: number) => {from: number, to: number, text: string}} line from 1
 */

/**
 * @param {readonly Problem[]} problems
 * @param {string} file
 * @param {Lines} doc
 * @returns {{from: number, to: number, severity: Problem["severity"], message: string, problem: Problem}[]} in order
 */
export function marksOf(problems, file, doc) {
  return problems
    .flatMap((problem) => {
      const { severity, sentence, place } = problem;
      if (place?.file !== file || !place.line || place.line > doc.lines) return [];
      const line = doc.line(place.line);
      return [{ ...stretch(line, place.column), severity, message: sentence, problem }];
    })
    .sort((a, b) => a.from - b.from);
}

/**
 * The word at a column, the whole tag where a tag begins there, or the whole line.
 *
 * @param {{from: number, to: number, text: string}} line
 * @param {number} column from 1; 0: not known
 */
function stretch({ from, to, text }, column) {
  const indent = text.length - text.trimStart().length;
  if (column < 1 || column > text.length)
    return { from: Math.min(from + indent, to), to: from + text.trimEnd().length || to };
  const rest = text.slice(column - 1);
  const size = tagLength(rest) || WORD.exec(rest)?.[0].length || 1;
  return { from: from + column - 1, to: Math.min(from + column - 1 + size, to) };
}

/** @param {string} text that may begin with a tag @returns {number} 0: it does not */
function tagLength(text) {
  return /^<[\w:.-]+(?:"[^"]*"|'[^']*'|[^"'>])*>?/.exec(text)?.[0].trimEnd().length ?? 0;
}
