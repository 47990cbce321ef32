import assert from "node:assert/strict";
import { test } from "node:test";
import { progressOf } from "../../frontend_assets/panels/actions/actions.js";

test("a percentage is a share of a hundred, also at its beginning", () => {
  assert.deepEqual(progressOf([{ progress_pct: 0.5, status_line: "x" }]), {
    name: "progress_pct",
    share: 0.005,
  });
});

test("a progress without a unit is of one until it was more", () => {
  assert.equal(progressOf([{ progress: 0.25 }])?.share, 0.25);
  assert.equal(progressOf([{ progress: 1 }, { progress: 50 }])?.share, 0.5);
});

test("what is left is seen against the most that was", () => {
  const log = [{ info: { distance_remaining: 4 } }, { info: { distance_remaining: 1 } }];
  assert.equal(progressOf(log)?.share, 0.75);
});

test("feedback that tells no share has none", () => {
  assert.equal(progressOf([{ partial_sequence: [0, 1, 1] }]), null);
  assert.equal(progressOf([]), null);
});
