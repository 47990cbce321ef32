/** Waiting for the page to have nothing more urgent to do. */

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
