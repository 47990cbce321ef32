/** The browser's own cursor in the editor: within a text, where what is typed cannot go astray. */

/** @import { Extension, ViewUpdate } from "vendor/codemirror.js" */

import { EditorView } from "vendor/codemirror.js";

/**
 * When marks around a word are drawn anew, the browser's cursor is left between two elements, and
 * CodeMirror holds that for the same place. Chromium types there before the word, not behind it:
 * `<xacro:` and `l` gave `<xaclro:`.
 *
 * @returns {Extension}
 */
export const steadyCaret = () => EditorView.updateListener.of(keepWithinText);

/** @param {ViewUpdate} update */
function keepWithinText({ view }) {
  const { main } = view.state.selection;
  const selection = /** @type {Document} */ (view.root).getSelection();
  if (!view.hasFocus || view.composing || !main.empty) return;
  if (!isBetweenElements(selection, view)) return;
  const { node, offset } = view.domAtPos(main.head, -1);
  if (node instanceof Text) selection?.collapse(node, offset);
}

/** @param {Selection | null} selection @param {EditorView} view */
function isBetweenElements(selection, { contentDOM }) {
  const node = selection?.anchorNode;
  return node instanceof Element && node !== contentDOM && contentDOM.contains(node);
}
