import assert from "node:assert/strict";
import { test } from "node:test";
import {
  byHardware,
  levelCounts,
  levelOf,
  shownParts,
} from "../../frontend_assets/panels/diagnostics/diagnostics.js";

/** @param {string} name @param {number} level @param {Partial<import("../../frontend_assets/types/wire.d.ts").DiagnosticView>} [news] */
const part = (name, level, news = {}) => ({
  name,
  hardware: "hw",
  level,
  message: "as it is",
  values: [],
  age_s: 0.5,
  ...news,
});

test("a part that fell silent is stale, and an unknown level is an error", () => {
  assert.deepEqual(
    [0, 1, 2, 3, 9].map((level) => levelOf(part("a", level))),
    [...["ok", "warn", "error", "stale", "error"]],
  );
  assert.equal(levelOf(part("a", 0, { age_s: 60 })), "stale");
});

test("the gravest come first, and those below the least level are left out", () => {
  const parts = [part("a", 0), part("b", 2), part("c", 1), part("d", 0, { age_s: 99 })];
  const names = (/** @type {any} */ filter) => shownParts(parts, filter).map(({ name }) => name);
  assert.deepEqual(names({ least: "ok", words: "" }), ["d", "b", "c", "a"]);
  assert.deepEqual(names({ least: "error", words: "" }), ["d", "b"]);
  assert.deepEqual(names({ least: "ok", words: "B as" }), ["b"]);
  assert.deepEqual(levelCounts(parts), { ok: 1, warn: 1, error: 1, stale: 1 });
});

test("parts stand by their hardware", () => {
  const groups = byHardware([part("a", 0), part("b", 0, { hardware: "" }), part("c", 0)]);
  assert.deepEqual([...groups.keys()], ["hw", ""]);
  assert.equal(groups.get("hw")?.length, 2);
});
