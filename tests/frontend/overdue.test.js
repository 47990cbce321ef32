import assert from "node:assert/strict";
import { test } from "node:test";
import { overdue_s, secondsSince } from "../../frontend_assets/lib/times.js";

/** @param {number} count @param {number} period_s */
const every = (count, period_s) => Array.from({ length: count }, (_, n) => n * period_s);

test("what comes often is overdue after three seconds, and not a moment before", () => {
  const times_s = every(10, 0.1);
  assert.equal(overdue_s(times_s, 0.9 + 2.9), 0);
  assert.equal(overdue_s(times_s, 0.9 + 5), 5);
});

test("what comes seldom is given three of its periods", () => {
  const times_s = every(4, 10);
  assert.equal(overdue_s(times_s, 30 + 29), 0);
  assert.equal(overdue_s(times_s, 30 + 31), 31);
});

test("of what came once its period is not known; of what never came nothing is due", () => {
  assert.equal(overdue_s([5], 9), 4);
  assert.equal(overdue_s([], 1000), 0);
  assert.equal(overdue_s(new Float64Array(0), 1000), 0);
});

test("an age goes on between two answers, and is none before the clock was looked at again", () => {
  assert.equal(secondsSince(1000, 13_500), 12.5);
  assert.equal(secondsSince(1000, 400), 0);
});
