/** Which page of the help is shown to this person, and where. */

/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";

/**
 * @typedef {object} ShownHelp
 * @property {string} page empty: the list of all pages
 * @property {"left" | "right"} side of the window, away from what is asked about
 * @property {boolean} modal over a window that would have all keys and clicks otherwise
 */

/** @type {Signal<ShownHelp | null>} */
export const help = signal(null);
/** The pages read before this one, the newest last. @type {Signal<readonly string[]>} */
export const helpTrail = signal([]);
