/** Waiting for the page to have nothing more urgent to do. */

import { effect } from "vendor/preact.js";

const PATIENCE_MS = 1000;
const WITHOUT_IDLE_MS = 200;

/** @returns {Promise<void>} after what is being drawn now, and at the latest after a second */
export function untilIdle() {
  return new Promise((resolve) => {
    const done = () => resolve();
    if ("requestIdleCallback" in window) requestIdleCallback(done, { timeout: PATIENCE_MS });
    else setTimeout(done, WITHOUT_IDLE_MS);
  });
}

/** @param {() => boolean} holds reads signals @param {number} patience_ms @returns {Promise<void>} once it holds, or after that time */
export function until(holds, patience_ms) {
  return new Promise((resolve) => {
    const late = setTimeout(resolve, patience_ms);
    const stop = effect(() => {
      if (!holds()) return;
      clearTimeout(late);
      resolve();
    });
    setTimeout(stop, patience_ms);
  });
}
