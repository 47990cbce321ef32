/** Writes a text with places for the cursor into the source, on a line of its own. */

/** @import { EditorView } from "vendor/codemirror.js" */

import { snippet } from "vendor/codemirror.js";
import { snippetTemplate } from "../lib/snippets.js";

/**
 * @param {EditorView} view
 * @param {string} text
 * @param {readonly (readonly number[])[]} stops
 */
export function insertSnippet(view, text, stops) {
  const { from, to } = view.state.selection.main;
  const line = view.state.doc.lineAt(from);
  const before = line.text.slice(0, from - line.from);
  // Into an empty line; else below the line that the cursor is in, as deep as that one.
  const isFree = before.trim() === "" && line.text.slice(to - line.from).trim() === "";
  const template = snippetTemplate(text, stops);
  if (isFree) snippet(template)(view, null, from, to);
  else snippet(`\n${template}`)(view, null, line.to, line.to);
}

/**
 * A `{` or `(` behind `$` brings its other half, which is then typed over: a text that is never closed
 * is an error at every letter.
 *
 * @param {EditorView} view @param {number} from @param {number} to @param {string} text typed there
 * @returns {boolean} it was written here
 */
export function pairedBrackets(view, from, to, text) {
  if (from !== to || view.state.readOnly) return false;
  const { doc } = view.state;
  const line = doc.lineAt(from);
  const before = line.text.slice(0, from - line.from);
  const other = { "{": "}", "(": ")" }[text];
  if (other && /(?:^|[^$])\$$/.test(before)) {
    if (doc.sliceString(from, from + 1) === other) return false;
    write(view, from, from, text + other);
    return true;
  }
  const isOpen = /\$\{[^}]*$/.test(before) ? "}" : /\$\([^)]*$/.test(before) ? ")" : "";
  if (text !== isOpen || doc.sliceString(from, from + 1) !== text) return false;
  write(view, from, from + 1, text);
  return true;
}

/** @param {EditorView} view @param {number} from @param {number} to @param {string} text the cursor goes behind its first sign */
function write(view, from, to, text) {
  view.dispatch({
    changes: { from, to, insert: text },
    selection: { anchor: from + 1 },
    userEvent: "input.type",
    scrollIntoView: true,
  });
}
