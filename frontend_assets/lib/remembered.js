/** What this browser remembers between visits. */

import { effect, signal } from "vendor/preact.js";

const PREFIX = "studio.";

/** @param {string} key @returns {unknown} undefined when nothing usable is stored */
export function recall(key) {
  try {
    const text = localStorage.getItem(PREFIX + key);
    return text === null ? undefined : JSON.parse(text);
  } catch {
    return undefined;
  }
}

/** @param {string} key @param {unknown} value undefined forgets */
export function remember(key, value) {
  try {
    if (value === undefined) localStorage.removeItem(PREFIX + key);
    else localStorage.setItem(PREFIX + key, JSON.stringify(value));
  } catch {
    // A full or forbidden store costs the memory of a choice, nothing else.
  }
}

/**
 * @template T
 * @param {string} key
 * @param {T} initial
 * @param {(value: unknown) => boolean} [valid] refuses what an older or other page stored
 * @returns {import("vendor/preact.js").Signal<T>} stored at every change
 */
export function remembered(key, initial, valid = (value) => typeof value === typeof initial) {
  const stored = recall(key);
  const chosen = signal(
    stored !== undefined && valid(stored) ? /** @type {T} */ (stored) : initial,
  );
  let first = true;
  effect(() => {
    const { value } = chosen;
    if (!first) remember(key, value);
    first = false;
  });
  return chosen;
}
