import assert from "node:assert/strict";
import { test } from "node:test";
import { Bulk, FrameJoiner, takeSlot } from "../../frontend_assets/workers/bulk.js";
import { FrameError } from "../../frontend_assets/workers/frames.js";

const LARGE = new Uint8Array(256 * 1024 + 1);

/** @param {number[]} frame @returns {number[]} */
const onStream = (frame) => [frame.length, 0, 0, 0, ...frame];

/** @param {Uint8Array} stream @param {(at: number) => boolean} isCut */
function joined(stream, isCut) {
  /** @type {number[][]} */
  const frames = [];
  const joiner = new FrameJoiner((frame) => frames.push([...new Uint8Array(frame)]));
  let begin = 0;
  for (let at = 1; at <= stream.length; at += 1) {
    if (at < stream.length && !isCut(at)) continue;
    joiner.push(stream.subarray(begin, at));
    begin = at;
  }
  return frames;
}

const FRAMES = [[1], [2, 3, 4, 5, 6, 7, 8, 9, 10], [11, 12]];
const STREAM = Uint8Array.from(FRAMES.flatMap(onStream));

test("frames are put together again wherever their stream was cut", () => {
  assert.deepEqual(
    joined(STREAM, () => false),
    FRAMES,
  );
  assert.deepEqual(
    joined(STREAM, () => true),
    FRAMES,
  );
  for (let first = 1; first < STREAM.length; first += 1)
    for (let second = first; second < STREAM.length; second += 1)
      assert.deepEqual(
        joined(STREAM, (at) => at === first || at === second),
        FRAMES,
      );
});

test("a frame of no bytes, or of more than any message has, is refused", () => {
  for (const length of [
    [0, 0, 0, 0],
    [0, 0, 0, 255],
  ])
    assert.throws(() => joined(Uint8Array.from(length), () => false), FrameError);
});

/** What browsers have for all tabs of an origin, as far as it is used here. */
class Locks {
  constructor() {
    /** @type {Set<string>} */
    this.held = new Set();
  }

  /** @param {string} name @param {{ifAvailable: boolean}} options @param {(lock: object | null) => unknown} callback */
  async request(name, options, callback) {
    assert.ok(options.ifAvailable);
    if (this.held.has(name)) return callback(null);
    this.held.add(name);
    try {
      return await callback({ name });
    } finally {
      this.held.delete(name);
    }
  }
}

/** @param {Locks | undefined} locks */
const asManager = (locks) =>
  /** @type {LockManager | undefined} */ (/** @type {unknown} */ (locks));

/** Until all that was promised so far has come. */
const settled = () => new Promise((resolve) => setImmediate(resolve));

test("three tabs of a browser have a stream, and another one when one of them gives it back", async () => {
  const locks = asManager(new Locks());
  const slots = [];
  for (let tab = 0; tab < 8; tab += 1) slots.push(await takeSlot(locks));
  assert.equal(slots.filter(Boolean).length, 3);
  slots[1]?.();
  await settled();
  assert.ok(await takeSlot(locks));
  assert.equal(await takeSlot(locks), null);
});

test("where a browser has no locks, no tab has a stream", async () => {
  assert.equal(await takeSlot(undefined), null);
});

/** A worker with a stream that the test feeds. */
class Tab {
  constructor(locks = new Locks()) {
    this.asked = 0;
    /** @type {string[]} */
    this.addresses = [];
    /** @type {number[][]} */
    this.frames = [];
    /** @type {(readonly number[])[]} */
    this.lost = [];
    this.now_ms = 0;
    this.answers = true;
    /** @type {ReadableStreamDefaultController<Uint8Array> | null} */
    this.feed = null;
    this.bulk = new Bulk({
      askKey: () => {
        this.asked += 1;
      },
      take: (frame) => this.frames.push([...new Uint8Array(frame)]),
      lost: (channels) => this.lost.push(channels),
      locks: asManager(locks),
      fetch: async (address, { signal }) => this.answer(address, signal),
      now_ms: () => this.now_ms,
    });
  }

  /** @param {string} address @param {AbortSignal | null | undefined} signal */
  answer(address, signal) {
    this.addresses.push(address);
    if (!this.answers) throw new TypeError("Failed to fetch");
    const body = new ReadableStream({
      start: (feed) => {
        this.feed = feed;
        signal?.addEventListener("abort", () => feed.error(signal.reason));
      },
    });
    return new Response(body);
  }

  /** @param {number} channel */
  async notice(channel, cdr = LARGE, received_s = 1) {
    this.bulk.notice({ channel, cdr, received_s, sent_s: 0, lost: 0 });
    await settled();
  }

  /** Open, with its key told. @param {number} channel */
  async open(channel) {
    await this.notice(channel);
    const ended = this.bulk.open("a/key");
    await settled();
    return { ended };
  }
}

test("nothing is opened for small messages, and one stream for all large ones", async () => {
  const tab = new Tab();
  await tab.notice(1, LARGE.subarray(1));
  assert.equal(tab.asked, 0);
  await tab.notice(2);
  await tab.notice(3);
  assert.equal(tab.asked, 1);
  tab.bulk.open("a/key");
  await settled();
  assert.deepEqual(tab.addresses, ["/bulk?key=a%2Fkey"]);
  tab.feed?.enqueue(STREAM);
  await settled();
  assert.deepEqual(tab.frames, FRAMES);
});

test("it is closed when nothing large is heard, and its place is free", async () => {
  const locks = new Locks();
  const tab = new Tab(locks);
  await tab.notice(2);
  await tab.open(3);
  tab.bulk.leave(2);
  await settled();
  assert.equal(locks.held.size, 1);
  tab.bulk.leave(3);
  await settled();
  assert.equal(locks.held.size, 0);
  assert.deepEqual(tab.lost, [], "nobody asks for what nobody hears");
});

test("one that was lost is opened anew by the next large message, after a while", async () => {
  const locks = new Locks();
  const tab = new Tab(locks);
  const { ended } = await tab.open(2);
  tab.feed?.error(new TypeError("network error"));
  await ended;
  assert.deepEqual(tab.lost, [[2]]);
  assert.equal(locks.held.size, 0);
  await tab.notice(2);
  assert.equal(tab.asked, 1);
  tab.now_ms = 2_000;
  await tab.notice(2);
  assert.equal(tab.asked, 2);
});

test("a studio that refuses or is gone leaves the data lane to carry all", async () => {
  const tab = new Tab();
  tab.answers = false;
  await tab.open(2);
  assert.deepEqual(tab.lost, [[2]]);
  assert.equal(tab.bulk.stream, null);
});

test("a data lane that goes while a place is waited for leaves none behind", async () => {
  const locks = new Locks();
  const tab = new Tab(locks);
  const noticed = tab.notice(2);
  tab.bulk.forget();
  await noticed;
  await settled();
  assert.deepEqual([locks.held.size, tab.asked, tab.bulk.stream], [0, 0, null]);
});

test("what a newer one of its channel overtook on the other lane is old, unless the clock was set", async () => {
  const tab = new Tab();
  await tab.notice(2);
  const came = { channel: 2, cdr: LARGE, sent_s: 0, lost: 0 };
  const isOld = [5, 4.9, 5, 6, 5.5].map((received_s) =>
    tab.bulk.isOvertaken({ ...came, received_s }),
  );
  assert.deepEqual(isOld, [false, true, false, false, true]);
  assert.equal(tab.bulk.isOvertaken({ ...came, received_s: -10 }), false);
  assert.equal(tab.bulk.isOvertaken({ ...came, channel: 9, received_s: 0 }), false);
});
