import assert from "node:assert/strict";
import { test } from "node:test";
import { FrameJoiner, Spares } from "../../frontend_assets/workers/bulk.js";

/** @param {number[]} bytes @returns {Uint8Array} a frame as it comes in a stream */
const sent = (...bytes) => Uint8Array.of(bytes.length, 0, 0, 0, ...bytes);

test("a frame is put where another of its size was, once nobody reads that any more", () => {
  const spares = new Spares();
  /** @type {ArrayBuffer[]} */
  const frames = [];
  const joiner = new FrameJoiner((frame) => frames.push(frame), spares);
  joiner.push(sent(1, 2, 3));
  joiner.push(sent(4, 5, 6));
  const [first, second] = frames;
  assert.ok(first && second && first !== second);
  spares.give(first);
  joiner.push(sent(7, 8));
  joiner.push(sent(9, 9, 9));
  joiner.push(sent(3, 3, 3));
  assert.deepEqual(
    frames.map((frame) => frame === first),
    [true, false, false, true, false],
  );
  assert.deepEqual([...new Uint8Array(first)], [9, 9, 9]);
  assert.deepEqual([...new Uint8Array(second)], [4, 5, 6]);
});

test("no more is kept than two frames, the newest", () => {
  const spares = new Spares();
  for (const length of [1, 2, 3]) spares.give(new ArrayBuffer(length));
  assert.deepEqual(
    spares.kept.map((one) => one.byteLength),
    [2, 3],
  );
  spares.clear();
  assert.deepEqual(spares.kept, []);
});
