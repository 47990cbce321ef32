import assert from "node:assert/strict";
import { test } from "node:test";
import { keepAsking } from "../../frontend_assets/lib/asking.js";

test("it asks again after each answer, until it is ended", async () => {
  /** @type {number[]} */
  const taken = [];
  let asked = 0;
  await new Promise((enough) => {
    const end = keepAsking(
      async () => {
        asked += 1;
        return asked;
      },
      (answer) => {
        taken.push(answer);
        if (answer === 3) {
          end();
          enough(null);
        }
      },
      0,
    );
  });
  await new Promise((later) => setTimeout(later, 20));
  assert.deepEqual([asked, taken], [3, [1, 2, 3]]);
});

test("an answer that comes after the end is not taken", async () => {
  /** @type {((answer: string) => void)[]} */
  const waiting = [];
  const ask = () =>
    new Promise((/** @type {(answer: string) => void} */ answer) => waiting.push(answer));
  const end = keepAsking(ask, () => assert.fail("taken"), 0);
  end();
  for (const answer of waiting) answer("late");
  await new Promise((later) => setTimeout(later, 10));
  assert.equal(waiting.length, 1);
});
