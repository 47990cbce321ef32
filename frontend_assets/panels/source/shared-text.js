/**
 * One text that the studio and editors hold at once: what is typed here goes to the studio in small packets,
 * one under way at a time; what others change comes back and is woven in, without losing a letter of either.
 */

/** @import { EditText, TextChange } from "../../types/wire.d.ts" */
/** @import { Asked } from "../../model/wire.js" */

import { ChangeSet, Text } from "vendor/codemirror.js";
import { effect, untracked } from "vendor/preact.js";
import { settleFirst } from "../../lib/latest.js";
import { connection, documentId } from "../../model/connection.js";
import { followText } from "../../model/source.js";
import { notify } from "../../model/view.js";
import { LostError, RefusedError, send } from "../../model/wire.js";

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
  const reply = [];
  changes.iterChanges((start, end, _, __, text) => {
    reply.push({ start, end, text: text.toString() });
  });
  return reply;
}

/** @param {readonly TextChange[]} changes @param {number} length of the text before @returns {ChangeSet} */
function fromWire(changes, length) {
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

const OWN = crypto.getRandomValues(new Uint32Array(2)).join("-");
let links = 0;

/**
 * @typedef {object} TextLink
 * @property {string} file as the studio names it
 * @property {Text} doc as the studio has it
 * @property {Text} saved as the disk has it
 * @property {string} readOnly why it may not be edited; empty: it may
 * @property {SharedText} shared
 * @property {() => void} close
 */

/**
 * Fetch a text and keep it as the studio has it until it is closed.
 *
 * @param {string} file
 * @param {(changes: ChangeSet) => void} apply what others did
 * @returns {Promise<TextLink>}
 * @throws {RefusedError} when it is no text that may be shown
 * @throws {LostError} when the studio went away
 */
export async function linkText(file, apply) {
  const answer = await fetchText(file);
  const name = answer.file;
  links += 1;
  // Tells what was typed here from the edits of other tabs and people.
  const origin = `${OWN}-${links}`;
  const doc = Text.of(answer.text.split("\n"));
  const saved = answer.saved === null ? doc : Text.of(answer.saved.split("\n"));
  const refetch = async () => {
    const again = await fetchText(name).catch(() => null);
    if (again) shared.resync(again);
  };
  const shared = new SharedText({
    doc,
    version: answer.version,
    post: (packet) => post({ type: "edit_text", file: name, origin, ...packet }),
    apply,
    refetch,
  });
  const ends = [
    followText(name, (news) => shared.take({ ...news, own: news.origin === origin })),
    whenBack(refetch),
    settleFirst(
      () => shared.settled(),
      () => shared.busy,
    ),
  ];
  const close = () => {
    for (const end of ends) end();
  };
  return { file: name, doc, saved, readOnly: answer.read_only, shared, close };
}

/** @param {string} file */
async function fetchText(file) {
  const answer = await send({ type: "get_text", file });
  if (answer.type !== "text") throw new LostError();
  return answer;
}

/** @param {Asked<EditText>} command @returns {Promise<Fate>} */
async function post(command) {
  try {
    await send(command);
    return "taken";
  } catch (error) {
    if (!(error instanceof RefusedError)) return "lost";
    if (error.kind === "StaleTextError") return "stale";
    notify(error.message, { bad: true });
    return "refused";
  }
}

/** @param {() => void} run whenever the studio, or the document in it, has come back @returns {() => void} */
function whenBack(run) {
  let first = true;
  return effect(() => {
    const there = connection.value === "connected" && documentId.value !== "";
    if (there && !first) untracked(run);
    first = false;
  });
}
