/** While the pointer is on a line that sets a property, what it shapes lights up, as from its row. */

/** @import { Extension } from "vendor/codemirror.js" */

import { EditorView } from "vendor/codemirror.js";
import { allSites } from "../model/document.js";
import { hoverSite } from "../model/origin.js";

/** @param {{file: string}} link @returns {Extension} for the editor of one text */
export function pointing(link) {
  let line = 0;
  /** @param {number} now line from 1; 0: none */
  const point = (now) => {
    if (now === line) return;
    line = now;
    hoverSite(now === 0 ? null : siteAt(link.file, now));
  };
  return EditorView.domEventHandlers({
    mousemove({ clientX, clientY }, view) {
      const at = view.posAtCoords({ x: clientX, y: clientY });
      point(at === null ? 0 : view.state.doc.lineAt(at).number);
    },
    mouseleave: () => point(0),
  });
}

/** @param {string} file @param {number} line @returns {string | null} of several the first */
function siteAt(file, line) {
  for (const one of allSites().values()) if (one.file === file && one.line === line) return one.id;
  return null;
}
