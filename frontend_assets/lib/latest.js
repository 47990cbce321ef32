import { signal } from "vendor/preact.js";

/** @type {Map<() => Promise<void>, () => boolean>} who may have something under way, and whether it has */
const underWay = new Map();

/** @returns {Promise<void>} when all that was pushed anywhere has been answered: undo must not overtake it */
export async function allSettled() {
  await Promise.all([...underWay.keys()].map((settled) => settled()));
}

/** @returns {boolean} something was pushed or typed that the studio has not answered yet */
export const anyUnderWay = () => [...underWay.values()].some((busy) => busy());

/**
 * Have `allSettled` wait for something of one's own, too.
 *
 * @param {() => Promise<void>} settled
 * @param {() => boolean} busy
 * @returns {() => void} ends it
 */
export function settleFirst(settled, busy) {
  underWay.set(settled, busy);
  return () => underWay.delete(settled);
}

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
    underWay.delete(settled);
    const done = watchers;
    watchers = [];
    for (const tell of done) tell();
  }

  /** @type {() => Promise<void>} */
  const settled = () =>
    new Promise((resolve) => {
      watchers.push(resolve);
      settle();
    });

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
      underWay.set(settled, busy);
      schedule();
    },
    settled,
  };
}

/**
 * Values that are set many times a second, by whose they are and their name: of each the newest wins,
 * and is shown at once.
 *
 * @template T
 * @param {(owner: string, name: string, value: T) => Promise<unknown>} send
 */
export function latestValues(send) {
  /** @type {import("vendor/preact.js").Signal<ReadonlyMap<string, T>>} */
  const onTheirWay = signal(new Map());
  /** @type {Map<string, ReturnType<typeof latestSender<T>>>} */
  const senders = new Map();
  const keyOf = (/** @type {string} */ owner, /** @type {string} */ name) => `${owner} ${name}`;
  return {
    /** @param {string} owner @param {string} name @returns {T | undefined} as it is about to be */
    coming: (owner, name) => onTheirWay.value.get(keyOf(owner, name)),
    /** @param {string} owner @param {string} name @param {T} value */
    async set(owner, name, value) {
      const key = keyOf(owner, name);
      const sender =
        senders.get(key) ?? latestSender((/** @type {T} */ newest) => send(owner, name, newest));
      senders.set(key, sender);
      onTheirWay.value = new Map(onTheirWay.value).set(key, value);
      sender.push(value);
      await sender.settled();
      if (sender.busy()) return;
      senders.delete(key);
      const left = new Map(onTheirWay.value);
      left.delete(key);
      onTheirWay.value = left;
    },
  };
}
