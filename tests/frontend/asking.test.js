import assert from "node:assert/strict";
import { test } from "node:test";
import { keepAsking } from "../../frontend_assets/model/asking.js";

/** Longer than any test takes. */
const LONG_MS = 600_000;
const turn = () => new Promise((later) => setTimeout(later, 0));

test("it asks again after each answer, until it is ended", async () => {
  let asked = 0;
  await new Promise((enough) => {
    const end = keepAsking(async () => {
      asked += 1;
      if (asked < 3) return;
      end();
      enough(null);
    }, 0);
  });
  await turn();
  await turn();
  assert.equal(asked, 3);
});

test("where there is more, it asks at once; and never twice at a time", async () => {
  /** @type {((more: boolean) => void)[]} */
  const answers = [];
  const ask = () =>
    new Promise((/** @type {(more: boolean) => void} */ answer) => answers.push(answer));
  const end = keepAsking(ask, LONG_MS);
  await turn();
  assert.equal(answers.length, 1, "nothing is asked before the answer");
  answers[0]?.(true);
  while (answers.length < 2) await turn();
  answers[1]?.(false);
  await turn();
  assert.equal(answers.length, 2, "with nothing more it rests");
  end();
});
