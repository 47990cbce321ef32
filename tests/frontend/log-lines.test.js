import assert from "node:assert/strict";
import { test } from "node:test";
import {
  goneBefore,
  levelOf,
  logText,
  matchingLines,
  nodesOf,
  withNews,
} from "../../frontend_assets/model/log.js";
import { rowsNear } from "../../frontend_assets/panels/log/log.js";

/** @param {number} number @param {Partial<import("../../frontend_assets/types/wire.d.ts").LogLine>} [news] */
const line = (number, news = {}) => ({
  number,
  stamp_s: 1.5,
  level: 20,
  node: "talker",
  text: `said ${number}`,
  file: "",
  function: "",
  line: 0,
  ...news,
});

test("a level counts from its number on", () => {
  assert.deepEqual([0, 10, 19, 20, 30, 45, 50, 255].map(levelOf), [
    ...["debug", "debug", "debug", "info", "warn", "error", "fatal", "fatal"],
  ]);
});

test("lines are chosen by level, node and every word", () => {
  const lines = [
    line(1, { level: 10 }),
    line(2, { node: "arm.motor", text: "Hot motor" }),
    line(3, { node: "arm", level: 40, text: "motor stalls" }),
  ];
  /** @param {Partial<import("../../frontend_assets/model/log.js").Filter>} news */
  const numbers = (news) =>
    matchingLines(lines, { level: "debug", node: "", words: "", ...news }).map(
      ({ number }) => number,
    );
  assert.deepEqual(numbers({}), [1, 2, 3]);
  assert.deepEqual(numbers({ level: "info" }), [2, 3]);
  assert.deepEqual(numbers({ node: "arm" }), [2, 3]);
  assert.deepEqual(numbers({ words: "MOTOR hot" }), [2]);
  assert.deepEqual(nodesOf(lines), ["arm", "talker"]);
});

test("ten thousand lines are kept, and the oldest go together", () => {
  let lines = /** @type {readonly ReturnType<typeof line>[]} */ ([]);
  for (let n = 0; n < 30; n += 1)
    lines = withNews(
      lines,
      Array.from({ length: 500 }, (_, at) => line(n * 500 + at)),
    );
  assert.ok(lines.length >= 10_000 && lines.length <= 11_000);
  assert.equal(lines.at(-1)?.number, 14_999);
});

test("how many of the oldest lines are gone is known, so that what is read can stay in place", () => {
  const lines = [1, 2, 3, 4].map((number) => line(number));
  assert.equal(goneBefore(lines, lines.slice(2)), 2);
  assert.equal(goneBefore(lines, [...lines, line(5)]), 0);
  assert.equal(goneBefore(lines, []), 0);
  assert.equal(goneBefore([], lines), 0);
});

test("lines are copied as ROS writes them", () => {
  assert.equal(logText([line(1, { level: 30 })]), "[WARN] [1.500000000] [talker]: said 1");
});

test("only rows near the view are drawn, however long the list is", () => {
  const near = rowsNear({ count: 10_000, row_px: 26, top_px: 130_000, view_px: 260 });
  assert.ok(near.from <= 5_000 && near.to >= 5_010 && near.to - near.from < 50);
  assert.deepEqual(rowsNear({ count: 3, row_px: 26, top_px: 0, view_px: 260 }), { from: 0, to: 3 });
  assert.deepEqual(rowsNear({ count: 0, row_px: 26, top_px: 900, view_px: 9 }), { from: 0, to: 0 });
  assert.deepEqual(rowsNear({ count: 9, row_px: 0, top_px: 0, view_px: 9 }), { from: 0, to: 0 });
});
