/**
 * One text that several hold at once: what is typed here goes to the studio in small packets, one under
 * way at a time; what others change comes back and is woven in, without losing a letter of either.
 */

/** @import { TextChange } from "../types/wire.d.ts" */

// By its path, so that the tests of this file find it without the page's import map.
import { ChangeSet, Text } from "../vendor/codemirror.js";

const IDLE_MS = 120;
const AT_MOST_MS = 350;

/**
 * @typedef {{version: number, changes: readonly TextChange[], gesture: string}} Packet
 * @typedef {"taken" | "stale" | "refused" | "lost"} Fate of a packet; `taken` says nothing new: its echo did
 * @typedef {{version: number, changes: readonly TextChange[], own: boolean}} News
 * @typedef {{changes: ChangeSet, gesture: string}} Typed
 */

/**
 * @typedef {object} Options
 * @property {Text} doc as the studio has it
 * @property {number} version of it
 * @property {(packet: Packet) => Promise<Fate>} post
 * @property {(changes: ChangeSet) => void} apply what others did, for the text as it stands here
 * @property {() => void} refetch ask for the whole text, which then comes by `resync`
 * @property {(run: () => void, ms: number) => () => void} [wait] calls later, unless what it returns is called
 */

/**
 * @typedef {object} SharedText
 * @property {(changes: ChangeSet, gesture: string) => void} type
 * @property {() => void} flush send at once, when the way is free
 * @property {(news: News) => void} take what the studio told
 * @property {(text: {version: number, text: string}) => void} resync after the lane was lost
 * @property {() => Promise<void>} settled all that was typed has arrived, or cannot
 * @property {() => Text} known as the studio has it, without what is typed and not there yet
 * @property {() => boolean} busy something typed is not at the studio yet
 */

/** @param {Options} options @returns {SharedText} */
export function createSharedText({ doc, version, post, apply, refetch, wait = later }) {
  let base = doc;
  let at = version;
  /** @type {Typed | null} */
  let flight = null;
  /** @type {Typed | null} */
  let unsent = null;
  let lost = false;
  /** @type {(() => void) | null} */
  let stopWaiting = null;
  let firstTyped = 0;
  /** @type {(() => void)[]} */
  let watchers = [];

  const busy = () => flight !== null || unsent !== null;

  function settle() {
    if (busy() && !lost) return;
    const done = watchers;
    watchers = [];
    for (const tell of done) tell();
  }

  function flush() {
    stopWaiting?.();
    stopWaiting = null;
    if (flight || !unsent || lost) return;
    const packet = unsent;
    flight = packet;
    unsent = null;
    const seen = at;
    post({ version: at, changes: onWire(packet.changes), gesture: packet.gesture }).then((fate) =>
      land(fate, seen),
    );
  }

  function arrange() {
    if (unsent?.changes.empty) unsent = null;
    if (!unsent) return settle();
    const now = Date.now();
    firstTyped ||= now;
    stopWaiting?.();
    stopWaiting = wait(
      () => {
        firstTyped = 0;
        flush();
      },
      Math.min(IDLE_MS, Math.max(0, firstTyped + AT_MOST_MS - now)),
    );
    return undefined;
  }

  /** @param {Fate} fate @param {number} seen version that it was typed in */
  function land(fate, seen) {
    if (!flight || fate === "taken") return;
    if (fate === "refused") return giveUp();
    if (fate === "lost") {
      lost = true;
      return settle();
    }
    const again = flight;
    flight = null;
    unsent = joined(again, unsent);
    // Nothing newer came, and yet it is stale: the studio knows another text.
    if (seen === at) refetchOnce();
    else flush();
    return undefined;
  }

  function refetchOnce() {
    lost = true;
    refetch();
  }

  function giveUp() {
    const all = joined(flight, unsent);
    flight = null;
    unsent = null;
    if (all) apply(all.changes.invert(base));
    settle();
  }

  /** @param {ChangeSet} incoming for `base` as it was before it */
  function weave(incoming) {
    let remote = incoming;
    for (const typed of [flight, unsent]) {
      if (!typed) continue;
      const mine = typed.changes;
      typed.changes = mine.map(remote);
      remote = remote.map(mine, true);
    }
    if (!remote.empty) apply(remote);
  }

  return {
    busy,
    flush,
    known: () => base,
    type(changes, gesture) {
      const before = unsent;
      if (before && before.gesture !== gesture) flush();
      unsent = joined(unsent, { changes, gesture });
      arrange();
    },
    take(news) {
      if (news.version <= at) return;
      if (news.version !== at + 1) return refetchOnce();
      const incoming = fromWire(news.changes, base.length);
      const mine = news.own && flight !== null;
      base = incoming.apply(base);
      at = news.version;
      if (mine) flight = null;
      else weave(incoming);
      if (mine && unsent) arrange();
      else settle();
      return undefined;
    },
    resync({ version: newVersion, text }) {
      const now = Text.of(text.split("\n"));
      const arrived = flight?.changes.apply(base).eq(now) ?? false;
      const incoming = difference(base, now);
      base = now;
      at = newVersion;
      lost = false;
      if (arrived) flight = null;
      else weave(incoming);
      unsent = joined(flight, unsent);
      flight = null;
      arrange();
    },
    settled() {
      firstTyped = 0;
      flush();
      return new Promise((resolve) => {
        watchers.push(resolve);
        settle();
      });
    },
  };
}

/** @param {() => void} run @param {number} ms @returns {() => void} */
function later(run, ms) {
  const timer = setTimeout(run, ms);
  return () => clearTimeout(timer);
}

/** @param {Typed | null} first @param {Typed | null} second typed after it @returns {Typed | null} */
function joined(first, second) {
  if (!first || !second) return first ?? second;
  return { changes: first.changes.compose(second.changes), gesture: first.gesture };
}

/** @param {ChangeSet} changes @returns {TextChange[]} */
export function onWire(changes) {
  /** @type {TextChange[]} */
  const told = [];
  changes.iterChanges((start, end, _, __, text) => {
    told.push({ start, end, text: text.toString() });
  });
  return told;
}

/** @param {readonly TextChange[]} changes @param {number} length of the text before @returns {ChangeSet} */
export function fromWire(changes, length) {
  const specs = changes.map(({ start, end, text }) => ({
    from: start,
    to: end,
    insert: Text.of(text.split("\n")),
  }));
  return ChangeSet.of(specs, length);
}

/** @param {Text} before @param {Text} now @returns {ChangeSet} the one stretch in which they differ */
export function difference(before, now) {
  const old = before.toString();
  const fresh = now.toString();
  const shorter = Math.min(old.length, fresh.length);
  let start = 0;
  while (start < shorter && old[start] === fresh[start]) start += 1;
  let end = 0;
  while (end < shorter - start && old.at(-1 - end) === fresh.at(-1 - end)) end += 1;
  const insert = now.slice(start, fresh.length - end);
  return ChangeSet.of({ from: start, to: old.length - end, insert }, old.length);
}
