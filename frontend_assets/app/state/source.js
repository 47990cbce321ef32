/** Which text the source panel shows and where in it; other panels ask here for a line to be shown. */

/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";
import { commandById } from "../commands.js";

/**
 * A place in a text; line and column from 1. Each wish is an object of its own, so that the same place
 * can be wanted twice.
 * @typedef {{file: string, line: number, column: number}} WantedPlace
 */

/** Where the source panel goes next; it takes the wish away when it is there. @type {Signal<WantedPlace | null>} */
export const wantedPlace = signal(null);

/** The file in front in the source panel; empty: none. @type {Signal<string>} */
export const shownFile = signal("");

/**
 * Bring the source panel to the front with this line in view and the cursor on it.
 *
 * @param {string} file as the studio names it
 * @param {number} line from 1
 * @param {number} [column] from 1
 */
export function showSource(file, line, column = 1) {
  wantedPlace.value = { file, line: Math.max(line, 1), column: Math.max(column, 1) };
  commandById("panel.source")?.run();
}
