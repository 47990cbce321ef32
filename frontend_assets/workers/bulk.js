/**
 * The bulk lane: large messages on one streamed answer, which a browser takes several times as fast
 * as a WebSocket. It is open only while something large is heard, and by few tabs of a browser at
 * once: it may hold six connections to a studio, and the others are for saving and loading.
 */

/** @import { Came } from "./frames.js" */

import { address } from "../lib/address.js";
import { FrameError } from "./frames.js";

/** Tabs of a browser that have one at the same time. */
const SLOTS = 3;
const RETRY_MS = 1500;
const LENGTH_BYTES = 4;
const FRAME_MAX = 1 << 30;
/** Of a message, as in `studio/live/topics/frames.py`. */
const LARGE_BYTES = 256 * 1024;
/** One that is older than the newest by more is not late: the studio's clock was set back. */
const OVERTAKEN_S = 10;

/** Puts frames together again, however their stream was cut; each byte is copied once. */
export class FrameJoiner {
  /** @param {(frame: ArrayBuffer) => void} take @param {Spares} [spares] where a frame may be put */
  constructor(take, spares = new Spares()) {
    this.take = take;
    this.spares = spares;
    this.length = new Uint8Array(LENGTH_BYTES);
    /** @type {Uint8Array<ArrayBuffer>} what is being filled: a length, or the frame after it */
    this.filling = this.length;
    this.filled = 0;
  }

  /** @param {Uint8Array} piece @throws {FrameError} */
  push(piece) {
    let at = 0;
    while (at < piece.length) {
      const end = Math.min(piece.length, at + this.filling.length - this.filled);
      this.filling.set(piece.subarray(at, end), this.filled);
      this.filled += end - at;
      at = end;
      if (this.filled === this.filling.length) this.finish();
    }
  }

  finish() {
    const { filling } = this;
    this.filled = 0;
    if (filling === this.length) {
      this.filling = this.spares.take(frameLength(filling));
    } else {
      this.filling = this.length;
      this.take(filling.buffer);
    }
  }
}

/** @param {Uint8Array<ArrayBuffer>} bytes @returns {number} @throws {FrameError} */
function frameLength(bytes) {
  const length = new DataView(bytes.buffer).getUint32(0, true);
  if (length === 0 || length > FRAME_MAX) throw new FrameError("its length cannot be");
  return length;
}

/**
 * One of the few places for streams of this browser.
 *
 * @param {LockManager | undefined} locks none where the page did not come over a secure connection
 * @returns {Promise<(() => void) | null>} gives the place back; null: all are taken
 */
export async function takeSlot(locks) {
  for (let slot = 1; locks && slot <= SLOTS; slot += 1) {
    const release = await tryLock(locks, `studio-bulk-${slot}`);
    if (release) return release;
  }
  return null;
}

/** @param {LockManager} locks @param {string} name @returns {Promise<(() => void) | null>} */
function tryLock(locks, name) {
  return new Promise((resolve) => {
    locks.request(name, { ifAvailable: true }, (lock) => {
      if (lock) return new Promise((release) => resolve(() => release(undefined)));
      resolve(null);
      return undefined;
    });
  });
}

/**
 * @typedef {object} Surroundings
 * @property {() => void} askKey on the data lane; the answer goes to `open`
 * @property {(frame: ArrayBuffer) => void} take
 * @property {(channels: readonly number[]) => void} lost what was on its way on these is gone
 * @property {LockManager | undefined} locks
 * @property {(address: string, options: RequestInit) => Promise<Response>} fetch
 * @property {() => number} now_ms
 */

/** The stream of this worker: wanted as soon as something large comes, and while that is heard. */
export class Bulk {
  /** @param {Surroundings} surroundings */
  constructor(surroundings) {
    this.surroundings = surroundings;
    /** @type {Map<number, number>} channels on which something large came, and when the newest did, in s */
    this.channels = new Map();
    /** @type {AbortController | null} null: there is no stream, nor will there be one soon */
    this.stream = null;
    this.tried_ms = Number.NEGATIVE_INFINITY;
    this.spares = new Spares();
  }

  /** Something came over the data lane. @param {Came} came */
  notice({ channel, cdr }) {
    if (cdr.length <= LARGE_BYTES) return;
    if (!this.channels.has(channel)) this.channels.set(channel, Number.NEGATIVE_INFINITY);
    const now_ms = this.surroundings.now_ms();
    if (this.stream || now_ms - this.tried_ms < RETRY_MS) return;
    this.tried_ms = now_ms;
    this.begin();
  }

  /** Whether a newer one came by the other lane. @param {Came} came */
  isOvertaken({ channel, received_s }) {
    const newest_s = this.channels.get(channel);
    if (newest_s === undefined) return false;
    if (received_s < newest_s && newest_s - received_s < OVERTAKEN_S) return true;
    this.channels.set(channel, received_s);
    return false;
  }

  async begin() {
    const stream = new AbortController();
    this.stream = stream;
    const release = await takeSlot(this.surroundings.locks);
    if (release && this.stream === stream) {
      stream.signal.addEventListener("abort", release);
      this.surroundings.askKey();
    } else {
      release?.();
      if (this.stream === stream) this.stream = null;
    }
  }

  /** @param {string} key told on the data lane */
  async open(key) {
    const { stream } = this;
    if (!stream) return;
    try {
      await this.read(key, stream.signal);
    } finally {
      if (this.stream === stream) {
        this.close();
        this.surroundings.lost([...this.channels.keys()]);
      }
    }
  }

  /** @param {string} key @param {AbortSignal} signal */
  async read(key, signal) {
    const path = address(`/bulk?key=${encodeURIComponent(key)}`);
    const asked = this.surroundings.fetch(path, { signal, cache: "no-store" });
    const answer = await asked.catch(none);
    if (!answer?.ok || !answer.body) return;
    const joiner = new FrameJoiner(this.surroundings.take, this.spares);
    for await (const piece of piecesOf(answer.body)) joiner.push(piece);
  }

  /** A channel is heard no more. @param {number} channel */
  leave(channel) {
    if (this.channels.delete(channel) && this.channels.size === 0) this.close();
  }

  /** The data lane is closed: what is heard gets other channels. */
  forget() {
    this.channels.clear();
    this.close();
  }

  close() {
    const { stream } = this;
    this.stream = null;
    this.spares.clear();
    stream?.abort();
  }
}

/** Until it ends or is lost. @param {ReadableStream<Uint8Array>} body */
async function* piecesOf(body) {
  const reader = body.getReader();
  let piece = await reader.read().catch(none);
  while (piece?.value) {
    yield piece.value;
    piece = await reader.read().catch(none);
  }
}

const none = () => null;

const KEPT_MOST = 2;

/**
 * Memory of frames that nobody reads any more. The next frame of that size is put there: to have
 * the same megabytes made anew for each picture of a camera takes longer than to fill them.
 */
export class Spares {
  constructor() {
    /** @type {ArrayBuffer[]} */
    this.kept = [];
  }

  /** @param {number} length @returns {Uint8Array<ArrayBuffer>} of any content */
  take(length) {
    const at = this.kept.findIndex((one) => one.byteLength === length);
    const [found] = at < 0 ? [] : this.kept.splice(at, 1);
    return new Uint8Array(found ?? new ArrayBuffer(length));
  }

  /** @param {ArrayBuffer} frame that nobody reads any more */
  give(frame) {
    this.kept = [...this.kept, frame].slice(-KEPT_MOST);
  }

  clear() {
    this.kept = [];
  }
}
