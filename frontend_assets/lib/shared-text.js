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
 * @typedef {{version: number, changes: TextChange[], gesture: string}} Packet
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
 * @property {(run: () => void, ms: number) => () => void} [wait] calls later, unless what it returns is called;
 *   a timer, when it is left out
 */

export class SharedText {
  /** The studio's text, at its version. */
  #base;
  #version;
  /** Under way. @type {Typed | null} */
  #flight = null;
  /** Typed since. @type {Typed | null} */
  #unsent = null;
  /** The lane was lost, or the whole text is on its way: nothing is sent until `resync`. */
  #lost = false;
  #waiting = { stop: () => {}, since: 0 };
  /** @type {(() => void)[]} */
  #watchers = [];
  #options;

  /** @param {Options} options */
  constructor(options) {
    this.#base = options.doc;
    this.#version = options.version;
    this.#options = { wait: later, ...options };
  }

  /** The text as the studio has it, without what is typed and not there yet. */
  get known() {
    return this.#base;
  }

  /** Something typed is not at the studio yet. */
  get busy() {
    return this.#flight !== null || this.#unsent !== null;
  }

  /** @param {ChangeSet} changes of the text as it stands here @param {string} gesture one step of undo */
  type(changes, gesture) {
    if (this.#unsent && this.#unsent.gesture !== gesture) this.flush();
    this.#unsent = joined(this.#unsent, { changes, gesture });
    this.#arrange();
  }

  /** Send at once, when the way is free. */
  flush() {
    this.#waiting.stop();
    this.#waiting = { stop: () => {}, since: 0 };
    if (this.#flight || !this.#unsent || this.#lost) return;
    const { changes, gesture } = this.#unsent;
    const seen = this.#version;
    this.#flight = this.#unsent;
    this.#unsent = null;
    this.#options
      .post({ version: seen, changes: onWire(changes), gesture })
      .then((fate) => this.#land(fate, seen));
  }

  /** @param {News} news that the studio told */
  take({ version, changes, own }) {
    if (version <= this.#version) return;
    if (version !== this.#version + 1) {
      this.#refetch();
      return;
    }
    const incoming = fromWire(changes, this.#base.length);
    this.#base = incoming.apply(this.#base);
    this.#version = version;
    if (own && this.#flight) this.#flight = null;
    else this.#weave(incoming);
    this.#arrange();
  }

  /** @param {{version: number, text: string}} text whole, after the lane was lost */
  resync({ version, text }) {
    const now = Text.of(text.split("\n"));
    const arrived = this.#flight?.changes.apply(this.#base).eq(now) ?? false;
    const incoming = difference(this.#base, now);
    this.#base = now;
    this.#version = version;
    this.#lost = false;
    if (arrived) this.#flight = null;
    else this.#weave(incoming);
    this.#unsent = joined(this.#flight, this.#unsent);
    this.#flight = null;
    this.#arrange();
  }

  /** @returns {Promise<void>} when all that was typed has arrived, or cannot */
  settled() {
    this.flush();
    return new Promise((resolve) => {
      this.#watchers.push(resolve);
      this.#settle();
    });
  }

  /** Send what is typed when the typing rests, or has gone on for long. */
  #arrange() {
    if (this.#unsent?.changes.empty) this.#unsent = null;
    this.#settle();
    if (!this.#unsent) return;
    const now = Date.now();
    const since = this.#waiting.since || now;
    const ms = Math.min(IDLE_MS, Math.max(0, since + AT_MOST_MS - now));
    this.#waiting.stop();
    this.#waiting = { stop: this.#options.wait(() => this.flush(), ms), since };
  }

  #settle() {
    if (this.busy && !this.#lost) return;
    const done = this.#watchers;
    this.#watchers = [];
    for (const tell of done) tell();
  }

  /** @param {Fate} fate of the packet under way @param {number} seen version that it was typed in */
  #land(fate, seen) {
    if (!this.#flight || fate === "taken") return;
    if (fate === "refused") this.#giveUp();
    else if (fate === "stale") this.#sendAgain(seen);
    else this.#lost = true;
    this.#settle();
  }

  /** @param {number} seen where nothing newer came since, the studio knows another text */
  #sendAgain(seen) {
    this.#unsent = joined(this.#flight, this.#unsent);
    this.#flight = null;
    if (seen === this.#version) this.#refetch();
    else this.flush();
  }

  #refetch() {
    this.#lost = true;
    this.#options.refetch();
  }

  /** Take out again what the studio refused, and what was typed on top of it. */
  #giveUp() {
    const all = joined(this.#flight, this.#unsent);
    this.#flight = null;
    this.#unsent = null;
    if (all) this.#options.apply(all.changes.invert(this.#base));
  }

  /** @param {ChangeSet} incoming for the studio's text as it was before it */
  #weave(incoming) {
    let remote = incoming;
    for (const typed of [this.#flight, this.#unsent]) {
      if (!typed) continue;
      const mine = typed.changes;
      typed.changes = mine.map(remote);
      remote = remote.map(mine, true);
    }
    if (!remote.empty) this.#options.apply(remote);
  }
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
