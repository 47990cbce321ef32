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
