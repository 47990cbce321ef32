/** Files on their way to the studio. */

/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";

/** @typedef {{name: string, done: number, total: number, cancel: () => void}} Sending bytes */

/** @type {Signal<Sending | null>} */
export const sending = signal(null);
/** Files are held over the page. */
export const dropping = signal(false);
