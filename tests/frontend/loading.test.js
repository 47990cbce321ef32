import assert from "node:assert/strict";
import { test } from "node:test";
import { courtesyMs } from "../../frontend_assets/lib/loading.js";

test("who was served at once waits for nobody", () => {
  assert.equal(courtesyMs(0), 0);
  assert.equal(courtesyMs(1500), 0);
});

test("who waited long leaves the line to others, for a while", () => {
  assert.equal(courtesyMs(12_000), 6000);
  assert.equal(courtesyMs(300_000), 10_000);
});
