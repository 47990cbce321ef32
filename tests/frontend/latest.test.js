import assert from "node:assert/strict";
import { test } from "node:test";
import { latestSender } from "../../frontend_assets/lib/latest.js";

/** A studio that answers when it is told to, and a screen that draws when it is told to. */
function stage() {
  /** @type {(() => void)[]} */
  const frames = [];
  /** @type {{value: number, answer: () => void, refuse: () => void}[]} */
  const sent = [];
  const sender = latestSender(
    (/** @type {number} */ value) =>
      new Promise((resolve, reject) =>
        sent.push({ value, answer: () => resolve(null), refuse: () => reject(new Error("no")) }),
      ),
    (callback) => frames.push(callback),
  );
  const draw = () => {
    for (const callback of frames.splice(0)) callback();
  };
  const turn = () => new Promise((resolve) => setImmediate(resolve));
  return { sender, sent, draw, turn, frames };
}

test("of many values in one frame only the newest is sent", () => {
  const { sender, sent, draw } = stage();
  for (const value of [1, 2, 3]) sender.push(value);
  assert.equal(sent.length, 0);
  draw();
  assert.deepEqual(
    sent.map(({ value }) => value),
    [3],
  );
});

test("one request is in flight; what was overtaken meanwhile is never sent", async () => {
  const { sender, sent, draw, turn } = stage();
  sender.push(1);
  draw();
  sender.push(2);
  sender.push(3);
  draw();
  assert.equal(sent.length, 1);
  sent[0]?.answer();
  await turn();
  draw();
  assert.deepEqual(
    sent.map(({ value }) => value),
    [1, 3],
  );
});

test("it is settled when the last value was answered, not before", async () => {
  const { sender, sent, draw, turn } = stage();
  let settled = false;
  sender.push(1);
  sender.settled().then(() => {
    settled = true;
  });
  draw();
  sender.push(2);
  sent[0]?.answer();
  await turn();
  assert.equal(settled, false);
  draw();
  sent[1]?.answer();
  await turn();
  assert.equal(settled, true);
  assert.equal(sender.busy(), false);
});

test("a refusal does not stop the next value", async () => {
  const { sender, sent, draw, turn } = stage();
  sender.push(1);
  draw();
  sent[0]?.refuse();
  await turn();
  sender.push(2);
  draw();
  assert.deepEqual(
    sent.map(({ value }) => value),
    [1, 2],
  );
});
