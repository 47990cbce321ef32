/** The topics that the page subscribes, and what it is told of their messages. */

/** @import { MessageView } from "../types/wire.d.ts" */
/** @import { Came } from "./frames.js" */
/** @import { Step } from "./message-paths.js" */

import { CdrError, readerOf } from "./cdr.js";
import { isList, numberAt, stepsOf, valueAt } from "./message-paths.js";

/**
 * @typedef {object} SubscribeCommand what goes to the studio
 * @property {number} subscription
 * @property {string} [document] whose time it is; empty: now
 * @property {string} topic
 * @property {string} type_name
 * @property {"every" | "newest"} mode
 * @property {number} most_hz
 * @property {"tick" | "at_once"} [pace]
 * @property {boolean | null} reliable
 * @property {boolean | null} latched
 * @property {number | null} depth
 */

/**
 * @typedef {object} SubscriptionView how a subscription stands, as the studio tells it
 * @property {"subscription"} type
 * @property {number} subscription
 * @property {number} channel
 * @property {"not_connected" | "no_publisher" | "other_type" | "refused" | "receiving"} state
 * @property {string} type_name
 * @property {string[]} types
 * @property {number} publishers
 * @property {boolean} reliable
 * @property {boolean} latched
 * @property {number} depth
 * @property {string} reason
 */

/**
 * @typedef {{kind: "message", subscription: number, received_s: number, lost: number, bytes: number, value: any, hex: string, trouble: string}} Echoed
 * @typedef {{kind: "points", subscription: number, times: Float64Array, values: Float64Array[], paths: readonly string[], lost: number, ahead_s: number, trouble: string}} Points `ahead_s`: so far the times are ahead of the sender's clock; NaN: it told none
 * @typedef {{kind: "state", subscription: number, view: SubscriptionView}} State
 * @typedef {{kind: "need", typeName: string}} Need
 * @typedef {{kind: "text", request: number, text: string}} TextAnswer
 * @typedef {{kind: "lane", open: boolean, dropped: number}} LaneState
 * @typedef {Echoed | Points | State | Need | TextAnswer | LaneState} ToPage
 */

/** Of a type that is not known it is asked so often whether somebody told it since. */
const ASK_AGAIN_MS = 5000;
/** A sender's clock that jumps so far is set anew. */
const JUMP_S = 0.5;

/** How types are read, as far as the studio told them. */
export class Types {
  /** @param {(message: ToPage) => void} post @param {() => number} now_ms */
  constructor(post, now_ms = () => performance.now()) {
    this.post = post;
    this.now_ms = now_ms;
    /** @type {Map<string, {read: ((cdr: Uint8Array) => any) | null, trouble: string} | null>} null: asked for */
    this.known = new Map();
    /** When each was told. @type {Map<string, number>} */
    this.told_ms = new Map();
  }

  /** @param {string} name @returns {{read: ((cdr: Uint8Array) => any) | null, trouble: string} | null} null: not yet */
  find(name) {
    const found = this.known.get(name);
    if (found !== undefined && !(found && this.isDoubtful(name, found))) return found;
    this.known.set(name, null);
    this.post({ kind: "need", typeName: name });
    return null;
  }

  /** @param {string} name @param {readonly MessageView[] | null} messages @param {string} reason why there are none */
  learn(name, messages, reason) {
    this.told_ms.set(name, this.now_ms());
    try {
      const read = messages && readerOf(messages, name);
      this.known.set(name, { read, trouble: reason });
    } catch (error) {
      this.known.set(name, { read: null, trouble: String(/** @type {Error} */ (error).message) });
    }
  }

  /** @param {string} name @param {{read: unknown}} told @returns {boolean} it was not known, and may be now */
  isDoubtful(name, { read }) {
    const since_ms = this.now_ms() - (this.told_ms.get(name) ?? 0);
    return !read && since_ms > ASK_AGAIN_MS;
  }

  /** Ask again for those that were not known: somebody may have told them since. */
  doubt() {
    for (const [name, one] of this.known) if (one && !one.read) this.known.delete(name);
  }
}

/** Times of a sender, by the studio's clock: those of its own are even, those of the arrival are not. */
export class SteadyClock {
  constructor() {
    this.offset_s = Number.NaN;
  }

  /** @param {{sent_s: number, received_s: number}} came @returns {number} */
  time({ sent_s, received_s }) {
    if (sent_s <= 0) return received_s;
    const time_s = sent_s + this.offset_s;
    if (Math.abs(time_s - received_s) < JUMP_S) return time_s;
    this.offset_s = received_s - sent_s;
    return received_s;
  }
}

/** A topic that is looked at: of what comes, the newest is shown. */
export class Echo {
  /** @param {SubscribeCommand} command @param {Types} types @param {(message: ToPage) => void} post */
  constructor(command, types, post) {
    this.command = command;
    this.types = types;
    this.post = post;
    this.typeName = "";
    /** @type {Map<string, number>} */
    this.unfolded = new Map();
    /** @type {Came | null} */
    this.last = null;
  }

  /** @param {readonly Came[]} messages */
  take(messages) {
    this.last = messages.at(-1) ?? this.last;
    this.show();
  }

  show() {
    const last = this.last;
    const type = this.typeName ? this.types.find(this.typeName) : null;
    if (!last || !type) return;
    const { value, trouble } = readWith(type, last.cdr);
    const hex = value === undefined ? hexRows(last.cdr) : "";
    const { subscription } = this.command;
    const { received_s, lost } = last;
    const bytes = last.cdr.length;
    const shown = value === undefined ? null : folded(value, this.unfolded);
    this.post({
      kind: "message",
      subscription,
      received_s,
      lost,
      bytes,
      value: shown,
      hex,
      trouble,
    });
  }

  /** @param {string} path @param {number} count */
  unfold(path, count) {
    this.unfolded.set(path, count);
    this.show();
  }

  /** @param {string} path @returns {string} the value there, all of it */
  text(path) {
    const type = this.types.find(this.typeName);
    if (!type || !this.last) return "";
    const { value } = readWith(type, this.last.cdr);
    return value === undefined
      ? hexRows(this.last.cdr)
      : wholeText(valueAt(value, stepsOf(path) ?? []));
  }
}

/** A topic of which numbers are drawn: every message counts. */
export class Trace {
  /** @param {SubscribeCommand} command @param {Types} types @param {(message: ToPage) => void} post @param {readonly string[]} paths */
  constructor(command, types, post, paths) {
    this.command = command;
    this.types = types;
    this.post = post;
    this.typeName = "";
    this.clock = new SteadyClock();
    /** @type {Came[]} until its type is known */
    this.waiting = [];
    this.choose(paths);
  }

  /** @param {readonly string[]} paths */
  choose(paths) {
    this.paths = paths;
    /** @type {(readonly Step[] | null)[]} */
    this.steps = paths.map(stepsOf);
  }

  /** @param {readonly Came[]} messages */
  take(messages) {
    this.waiting =
      this.waiting.length > WAITING_MAX ? [...messages] : [...this.waiting, ...messages];
    this.show();
  }

  show() {
    const type = this.typeName ? this.types.find(this.typeName) : null;
    if (!type || this.waiting.length === 0) return;
    const messages = this.waiting;
    this.waiting = [];
    const times = new Float64Array(messages.length);
    const values = (this.steps ?? []).map(() => new Float64Array(messages.length).fill(Number.NaN));
    let said = "";
    messages.forEach((came, n) => {
      times[n] = this.clock.time(came);
      const { value, trouble } = readWith(type, came.cdr);
      said ||= trouble;
      this.steps?.forEach((steps, at) => {
        const column = values[at];
        if (column && steps && value !== undefined) column[n] = numberAt(value, steps);
      });
    });
    const lost = messages.at(-1)?.lost ?? 0;
    const { subscription } = this.command;
    this.post({
      kind: "points",
      subscription,
      times,
      values,
      paths: this.paths ?? [],
      lost,
      ahead_s: this.clock.offset_s,
      trouble: said,
    });
  }
}

/** Messages that wait for their type to be told. */
const WAITING_MAX = 20_000;

/** @param {{read: ((cdr: Uint8Array) => any) | null, trouble: string}} type @param {Uint8Array} cdr @returns {{value: any, trouble: string}} value undefined: it cannot be read */
export function readWith({ read, trouble }, cdr) {
  if (!read) return { value: undefined, trouble };
  try {
    return { value: read(cdr), trouble: "" };
  } catch (error) {
    if (error instanceof CdrError) return { value: undefined, trouble: error.message };
    throw error;
  }
}

const ITEMS = 24;
const LETTERS = 2000;
const DEPTH_MAX = 70;
/** Of one message: a thousand markers are a thousand open lists. */
const VALUES_MAX = 6000;
const WHOLE_LETTERS = 1_000_000;

/** @typedef {{"@list": number, items: any[]} | {"@text": number, begin: string}} Cut what is longer than it is shown */

/**
 * @param {any} message as it was read
 * @param {ReadonlyMap<string, number>} wished by path: of so many items more is shown
 * @returns {any} plain values, and a Cut where something is left out
 */
export function folded(message, wished) {
  const room = { left: VALUES_MAX };
  return foldedAt(message, "", wished, room, 0);
}

/** @param {any} value @param {string} path @param {ReadonlyMap<string, number>} wished @param {{left: number}} room @param {number} depth @returns {any} */
function foldedAt(value, path, wished, room, depth) {
  room.left -= 1;
  if (typeof value === "string" && value.length > LETTERS)
    return { "@text": value.length, begin: value.slice(0, LETTERS) };
  if (isList(value)) return foldedList(value, path, wished, room, depth);
  if (typeof value !== "object" || value === null || depth > DEPTH_MAX) return value;
  /** @type {Record<string, any>} */
  const found = {};
  for (const [name, one] of Object.entries(value))
    found[name] = foldedAt(one, `${path}.${name}`, wished, room, depth + 1);
  return found;
}

/** @param {ArrayLike<any>} list @param {string} path @param {ReadonlyMap<string, number>} wished @param {{left: number}} room @param {number} depth */
function foldedList(list, path, wished, room, depth) {
  const most = Math.min(list.length, wished.get(path) ?? ITEMS, Math.max(0, room.left));
  const items = [];
  for (let n = 0; n < most && room.left > 0; n += 1)
    items.push(foldedAt(list[n], `${path}[${n}]`, wished, room, depth + 1));
  return items.length === list.length ? items : { "@list": list.length, items };
}

/** @param {any} value @returns {string} all of it, as JSON; cut where it is very long */
export function wholeText(value) {
  if (typeof value === "string") return value.slice(0, WHOLE_LETTERS);
  const text = JSON.stringify(value, plain, 1) ?? "";
  return text.slice(0, WHOLE_LETTERS);
}

/** @param {string} _key @param {any} value what JSON has no form for */
function plain(_key, value) {
  if (typeof value === "bigint")
    return Number.isSafeInteger(Number(value)) ? Number(value) : `${value}`;
  if (typeof value === "number" && !Number.isFinite(value)) return `${value}`;
  return ArrayBuffer.isView(value) ? Array.from(/** @type {any} */ (value)) : value;
}

/** @param {Uint8Array} bytes @returns {string} so many as are worth a look, in rows of 16 */
export function hexRows(bytes) {
  const rows = [];
  for (let at = 0; at < Math.min(bytes.length, 1024); at += 16) {
    const row = bytes.subarray(at, at + 16);
    const hex = Array.from(row, (one) => one.toString(16).padStart(2, "0")).join(" ");
    const text = Array.from(row, letterOf).join("");
    rows.push(`${at.toString(16).padStart(4, "0")}  ${hex.padEnd(47)}  ${text}`);
  }
  return rows.join("\n");
}

/** @param {number} code */
const letterOf = (code) => (code >= 32 && code < 127 ? String.fromCharCode(code) : "·");
