/**
 * Newest wins: at most one value per frame and one request in flight; what was overtaken is never
 * sent, and the last value always is.
 *
 * @template T
 * @param {(value: T) => Promise<unknown>} send its rejection ends the flight and is reported once
 * @param {(callback: () => void) => unknown} [nextFrame]
 * @returns {{push: (value: T) => void, settled: () => Promise<void>, busy: () => boolean}}
 */
export function latestSender(send, nextFrame = (callback) => requestAnimationFrame(callback)) {
  /** @type {{value: T} | null} */
  let waiting = null;
  let inFlight = false;
  let scheduled = false;
  /** @type {(() => void)[]} */
  let watchers = [];

  const busy = () => waiting !== null || inFlight;

  function settle() {
    if (busy()) return;
    const done = watchers;
    watchers = [];
    for (const tell of done) tell();
  }

  function schedule() {
    if (scheduled || inFlight || waiting === null) return;
    scheduled = true;
    nextFrame(depart);
  }

  async function depart() {
    scheduled = false;
    if (waiting === null || inFlight) return;
    const { value } = waiting;
    waiting = null;
    inFlight = true;
    try {
      await send(value);
    } catch {
      // The sender told the user; the next value may well be taken.
    }
    inFlight = false;
    schedule();
    settle();
  }

  return {
    busy,
    push(value) {
      waiting = { value };
      schedule();
    },
    settled: () =>
      new Promise((resolve) => {
        watchers.push(resolve);
        settle();
      }),
  };
}
