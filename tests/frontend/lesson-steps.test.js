import assert from "node:assert/strict";
import { test } from "node:test";
import { csvOf } from "../../frontend_assets/model/lesson-steps.js";

/** @param {string} name @param {(number | null)[]} done_s */
const row = (name, done_s) => ({ person: name, name, here: true, reads: true, done_s });

/** @param {ReturnType<typeof row>[]} rows */
const table = (...rows) => ({
  type: /** @type {const} */ ("lesson_table"),
  lesson: "l",
  steps: [],
  rows,
  request: 1,
});

test("a table is saved with names, and when each step was done", () => {
  const text = csvOf(table(row("Ada", [0, null]), row("Bob", [null, 1.5])), [
    "Name",
    "1. A",
    "2. B",
  ]);
  assert.equal(
    text,
    "Name,1. A,2. B\r\nAda,1970-01-01T00:00:00.000Z,\r\nBob,,1970-01-01T00:00:01.500Z\r\n",
  );
});

test("whatever a student is called, a spreadsheet takes it for text", () => {
  for (const name of ["=1+1", "+1", "-1", "@SUM(A1)", "\tx", "\rx"])
    assert.match(csvOf(table(row(name, [])), ["N"]), /^N\r\n"?'/);
  const text = csvOf(table(row('O"Neill, Ada', [])), ["Name"]);
  assert.equal(text, 'Name\r\n"O""Neill, Ada"\r\n');
});
