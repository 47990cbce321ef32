import assert from "node:assert/strict";
import { test } from "node:test";
import { dateWords, timeText } from "../../frontend_assets/panels/time/time.js";

test("times have two places, as in RViz, however large they are", () => {
  assert.equal(timeText(0), "0.00");
  assert.equal(timeText(12.346), "12.35");
  assert.equal(timeText(1_700_000_000.5), "1700000000.50");
});

test("a time of a simulation that begins at zero is no date", () => {
  assert.equal(dateWords(512), "");
  assert.match(dateWords(1_700_000_000), /2023/);
});
