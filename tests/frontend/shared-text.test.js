/** @import { Fate, Packet } from "../../frontend_assets/panels/source/shared-text.js" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { difference, onWire, SharedText } from "../../frontend_assets/panels/source/shared-text.js";
import { ChangeSet, Text } from "../../frontend_assets/vendor/codemirror.js";

/** @param {string} text */
const textOf = (text) => Text.of(text.split("\n"));

/** A studio that holds one text, and tells every change to all who share it, when it is asked to go on. */
class Studio {
  /** @param {string} text */
  constructor(text) {
    this.doc = textOf(text);
    this.version = 1;
    /** @type {Browser[]} */
    this.browsers = [];
    /** @type {(() => void)[]} */
    this.waiting = [];
  }

  /** @param {Browser} from @param {Packet} packet @returns {Promise<Fate>} */
  post(from, packet) {
    return new Promise((resolve) => {
      this.waiting.push(() => resolve(this.take(from, packet)));
    });
  }

  /** @param {Browser | null} from @param {Packet} packet @returns {Fate} */
  take(from, packet) {
    if (packet.changes.some(({ text }) => text.includes("€"))) return "refused";
    if (packet.version !== this.version) return "stale";
    const specs = packet.changes.map(({ start, end, text }) => ({
      from: start,
      to: end,
      insert: textOf(text),
    }));
    this.doc = ChangeSet.of(specs, this.doc.length).apply(this.doc);
    this.version += 1;
    for (const one of this.browsers)
      one.shared.take({
        version: this.version,
        changes: packet.changes,
        own: one === from,
      });
    return "taken";
  }

  /** Answer what waits, and what comes of it, until nobody has anything to say. */
  async settle() {
    for (let turn = 0; turn < 200; turn += 1) {
      this.waiting.shift()?.();
      for (const one of this.browsers) one.shared.flush();
      await new Promise((resolve) => setImmediate(resolve));
    }
  }
}

class Browser {
  /** @param {Studio} studio */
  constructor(studio) {
    this.doc = studio.doc;
    this.refetches = 0;
    this.shared = new SharedText({
      doc: studio.doc,
      version: studio.version,
      post: (packet) => studio.post(this, packet),
      apply: (changes) => {
        this.doc = changes.apply(this.doc);
      },
      refetch: () => {
        this.refetches += 1;
        this.shared.resync({ version: studio.version, text: studio.doc.toString() });
      },
      wait: () => () => {},
    });
    studio.browsers.push(this);
  }

  /** @param {number} from @param {number} to @param {string} insert */
  type(from, to, insert) {
    const changes = ChangeSet.of({ from, to, insert: textOf(insert) }, this.doc.length);
    this.doc = changes.apply(this.doc);
    this.shared.type(changes, "g");
  }
}

/** @param {Studio} studio */
const texts = (studio) => [studio.doc, ...studio.browsers.map(({ doc }) => doc)].map(String);

test("what is typed arrives, one packet under way at a time", async () => {
  const studio = new Studio("radius 0.1");
  const one = new Browser(studio);
  one.type(10, 10, "2");
  one.shared.flush();
  one.type(11, 11, "5");
  one.shared.flush();
  assert.equal(studio.waiting.length, 1);
  assert.equal(one.shared.busy, true);
  await studio.settle();
  assert.deepEqual(texts(studio), ["radius 0.125", "radius 0.125"]);
  assert.equal(studio.version, 3);
  assert.equal(one.shared.busy, false);
});

test("two who type at the same place both keep every letter, in one order", async () => {
  const studio = new Studio("ab");
  const one = new Browser(studio);
  const two = new Browser(studio);
  one.type(1, 1, "xy");
  two.type(1, 1, "uv");
  one.type(3, 3, "z");
  two.type(0, 1, "");
  await studio.settle();
  const [held, ...shown] = texts(studio);
  assert.deepEqual(shown, [held, held]);
  for (const letter of "xyzuvb") assert.ok(held?.includes(letter), `${letter} in ${held}`);
  assert.ok(!held?.includes("a"));
});

/** @param {number} seed @returns {(below: number) => number} whole numbers, the same in every run */
function dice(seed) {
  let state = seed;
  return (below) => {
    state = (state * 1103515245 + 12345) % 2147483648;
    return state % below;
  };
}

/** @param {Studio} studio @param {Browser} one @param {(below: number) => number} random */
function stroke(studio, one, random) {
  const from = random(one.doc.length + 1);
  const to = Math.min(one.doc.length, from + random(3));
  one.type(from, to, ["", "a", "\n", "xyz"][random(4)] ?? "");
  if (random(3) === 0) one.shared.flush();
  if (random(4) === 0) studio.waiting.shift()?.();
}

test("any two who type at random end with the same text", async () => {
  const random = dice(7);
  for (let round = 0; round < 25; round += 1) {
    const studio = new Studio("one\ntwo\nthree");
    const browsers = [new Browser(studio), new Browser(studio)];
    for (let count = 0; count < 12; count += 1) {
      const one = browsers[random(2)];
      if (one) stroke(studio, one, random);
      await Promise.resolve();
    }
    await studio.settle();
    const [held, ...shown] = texts(studio);
    assert.deepEqual(shown, [held, held]);
  }
});

test("a slider's change comes in before the typed letters that are still on their way", async () => {
  const studio = new Studio("a=1 b=2");
  const one = new Browser(studio);
  one.type(7, 7, "5");
  one.shared.flush();
  studio.take(null, { version: 1, changes: [{ start: 2, end: 3, text: "100" }], gesture: "" });
  assert.equal(String(one.doc), "a=100 b=25");
  await studio.settle();
  assert.deepEqual(texts(studio), ["a=100 b=25", "a=100 b=25"]);
});

test("what the studio refuses is taken out of the text again, with all that came after", async () => {
  const studio = new Studio("ab");
  const one = new Browser(studio);
  one.type(1, 1, "€");
  one.shared.flush();
  one.type(2, 2, "x");
  await studio.settle();
  assert.deepEqual(texts(studio), ["ab", "ab"]);
});

test("after the lane was lost, letters that had arrived are not written twice", async () => {
  const studio = new Studio("ab");
  const one = new Browser(studio);
  one.type(1, 1, "x");
  one.shared.flush();
  studio.browsers = [];
  studio.waiting.shift()?.();
  one.type(2, 2, "y");
  one.shared.resync({ version: studio.version, text: studio.doc.toString() });
  studio.browsers = [one];
  await studio.settle();
  assert.deepEqual(texts(studio), ["axyb", "axyb"]);
});

test("after the lane was lost, letters that had not arrived are sent again", async () => {
  const studio = new Studio("ab");
  const one = new Browser(studio);
  one.type(1, 1, "x");
  one.shared.flush();
  studio.waiting = [];
  studio.take(null, { version: 1, changes: [{ start: 0, end: 0, text: ">" }], gesture: "" });
  one.shared.resync({ version: studio.version, text: studio.doc.toString() });
  await studio.settle();
  assert.deepEqual(texts(studio), [">axb", ">axb"]);
});

test("a version that was missed makes the text be fetched again", () => {
  const studio = new Studio("ab");
  const one = new Browser(studio);
  studio.doc = textOf("abc");
  studio.version = 5;
  one.shared.take({ version: 5, changes: [], own: false });
  assert.equal(one.refetches, 1);
  assert.equal(String(one.doc), "abc");
});

test("who waits hears when all is there, or when the lane is lost", async () => {
  const studio = new Studio("ab");
  const one = new Browser(studio);
  await one.shared.settled();
  one.type(1, 1, "x");
  let done = false;
  const waited = one.shared.settled().then(() => {
    done = true;
  });
  await Promise.resolve();
  assert.equal(done, false);
  await studio.settle();
  await waited;
  assert.equal(String(studio.doc), "axb");
});

test("the difference of two texts is the one stretch between", () => {
  const told = (/** @type {string} */ a, /** @type {string} */ b) =>
    onWire(difference(textOf(a), textOf(b)));
  assert.deepEqual(told("a=1\nb", "a=12\nb"), [{ start: 3, end: 3, text: "2" }]);
  assert.deepEqual(told("aaa", "aa"), [{ start: 2, end: 3, text: "" }]);
  assert.deepEqual(told("same", "same"), []);
});
