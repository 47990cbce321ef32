/** Looks which relays are there. Its own policy lets it reach them; the page's does not. */

const PATIENCE_MS = 1500;

/** @param {string} url @returns {Promise<boolean>} whether anybody answers there; what, is not told */
const answers = (url) =>
  fetch(url, {
    mode: "no-cors",
    cache: "no-store",
    credentials: "omit",
    referrerPolicy: "no-referrer",
    signal: AbortSignal.timeout(PATIENCE_MS),
  }).then(
    () => true,
    () => false,
  );

/**
 * Asks all at once; the answer is the first of their order that is there, or null.
 *
 * @param {MessageEvent<readonly string[]>} event
 */
globalThis.onmessage = async ({ data: urls }) => {
  const asked = urls.map((url) => ({ url, there: answers(url) }));
  for (const { url, there } of asked) {
    if (!(await there)) continue;
    globalThis.postMessage(url);
    return;
  }
  globalThis.postMessage(null);
};
