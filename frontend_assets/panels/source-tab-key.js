/** The Tab key of the editor: it passes through until one has begun to edit, and indents from then on. */

/** @import { Extension, ViewUpdate } from "vendor/codemirror.js" */

import { EditorView } from "vendor/codemirror.js";

/**
 * Who walks through the page by Tab must neither change the text nor be caught in it. To leave
 * while editing, press Escape and then Tab.
 *
 * @param {(update: ViewUpdate) => boolean} typedHere
 * @returns {Extension}
 */
export function tabPassesThrough(typedHere) {
  return [
    EditorView.domEventHandlers({ mousedown, focus, blur }),
    EditorView.updateListener.of((update) => {
      if (update.docChanged && typedHere(update)) update.view.setTabFocusMode(false);
    }),
  ];
}

/** Views whose next focus is no walk: a click gives it, or the window that they lost it with. @type {WeakSet<EditorView>} */
const called = new WeakSet();

/** @param {MouseEvent} _ @param {EditorView} view */
function mousedown(_, view) {
  if (!view.hasFocus) called.add(view);
  view.setTabFocusMode(false);
}

/** @param {FocusEvent} _ @param {EditorView} view */
function blur(_, view) {
  if (!document.hasFocus()) called.add(view);
}

/** @param {FocusEvent} event @param {EditorView} view */
function focus({ relatedTarget }, view) {
  const within = relatedTarget instanceof Node && view.dom.contains(relatedTarget);
  if (!called.delete(view) && !within) view.setTabFocusMode(true);
}
