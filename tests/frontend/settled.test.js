import assert from "node:assert/strict";
import { test } from "node:test";
import { allSettled, latestSender } from "../../frontend_assets/lib/latest.js";

const turn = () => new Promise((resolve) => setImmediate(resolve));

test("what must not overtake an edit waits until every sender has its last answer", async () => {
  /** @type {(() => void)[]} */
  const answers = [];
  const send = () =>
    new Promise((resolve) => {
      answers.push(() => resolve(null));
    });
  const sender = latestSender(send, (callback) => callback());
  sender.push(1);
  let done = false;
  const waited = allSettled().then(() => {
    done = true;
  });
  sender.push(2);
  answers[0]?.();
  await turn();
  assert.equal(done, false);
  answers[1]?.();
  await waited;
  assert.equal(done, true);
  await allSettled();
});
