/** What becomes of edits: what was restored, and when saving shows first what it would write. */

/** @import { LeftWork, LeftWorkEntry, Restored } from "../../types/wire.d.ts" */

import { signal } from "vendor/preact.js";
import { remembered } from "../../lib/remembered.js";

/** Edits of an earlier run that the studio brought back. @type {import("vendor/preact.js").Signal<Restored | null>} */
export const restored = signal(null);

/** @param {Restored} event */
export function takeRestored(event) {
  restored.value = event.at ? event : null;
}

/** Unsaved work on files that are not open. @type {import("vendor/preact.js").Signal<readonly LeftWorkEntry[]>} */
export const leftWork = signal([]);

/** @param {LeftWork} event */
export function takeLeftWork(event) {
  leftWork.value = event.entries;
}

export const SAVE_CHOICES = /** @type {const} */ (["always", "several", "never"]);

/** When the changes are shown before they are written. @type {import("vendor/preact.js").Signal<typeof SAVE_CHOICES[number]>} */
export const showBeforeSaving = remembered(
  "save.show",
  /** @type {typeof SAVE_CHOICES[number]} */ ("always"),
  (value) => SAVE_CHOICES.some((one) => one === value),
);
