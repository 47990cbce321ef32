/** @import { Problem } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { changedLines } from "../../frontend_assets/lib/text-differences.js";
import { indentationOf } from "../../frontend_assets/panels/source/editor.js";
import { marksOf } from "../../frontend_assets/panels/source/source.js";
import { tabNames } from "../../frontend_assets/panels/source/tabs.js";
import { Text } from "../../frontend_assets/vendor/codemirror.js";

const LINES = [
  "<robot>",
  '  <xacro:property name="a" value="${b}"/> <!-- c -->',
  "  radius: 0.1  ",
];
const DOC = Text.of(LINES);

/** @param {number} line @param {number} column @param {string} [file] @returns {Problem} */
const problem = (line, column, file = "a.xacro") => ({
  severity: "error",
  code: "x",
  sentence: "Wrong.",
  place: { file, line, column },
  include_chain: [],
  macro_stack: [],
  fix: null,
  parts: [],
});

/** @param {Problem[]} problems */
const underlined = (...problems) =>
  marksOf(problems, "a.xacro", DOC).map(({ from, to }) => DOC.sliceString(from, to));

test("a problem underlines the tag, the word, or the whole line that it names", () => {
  assert.deepEqual(underlined(problem(2, 3)), ['<xacro:property name="a" value="${b}"/>']);
  assert.deepEqual(underlined(problem(2, 35)), ["${b}"]);
  assert.deepEqual(underlined(problem(3, 3)), ["radius"]);
  assert.deepEqual(underlined(problem(3, 0)), ["radius: 0.1"]);
  assert.deepEqual(underlined(problem(3, 99)), ["radius: 0.1"]);
});

test("problems of other files and of lines that are gone underline nothing", () => {
  assert.deepEqual(underlined(problem(1, 1, "b.xacro"), problem(99, 1), problem(0, 0)), []);
  assert.deepEqual(marksOf([{ ...problem(1, 1), place: null }], "a.xacro", DOC), []);
});

test("problems come in the order of the text", () => {
  assert.deepEqual(underlined(problem(3, 3), problem(1, 1)), ["<robot>", "radius"]);
});

test("new lines indent as the old ones do", () => {
  assert.equal(indentationOf(["<a>", "    <b>", "        <c/>", "    </b>", "</a>"]), "    ");
  assert.equal(indentationOf(["<a>", "  <b/>", "", "  <c>", "    <d/>"]), "  ");
  assert.equal(indentationOf(["<a>", "\t<b/>", "\t<c/>", "  <d/>"]), "\t");
  assert.equal(indentationOf(["flat", "flat"]), "  ");
  assert.equal(indentationOf([]), "  ");
});

test("a tab says as much of the folder as tells two files of one name apart", () => {
  const names = tabNames(["/w/a/urdf/arm.xacro", "/w/b/urdf/arm.xacro", "/w/b/urdf/base.xacro"]);
  assert.deepEqual(
    [...names.values()],
    [
      { name: "arm.xacro", folder: "a/urdf" },
      { name: "arm.xacro", folder: "b/urdf" },
      { name: "base.xacro", folder: "" },
    ],
  );
});

/** @param {string} before @param {string} now one letter a line */
const marked = (before, now) =>
  changedLines([...before], [...now]).map(({ line, kind }) => `${line} ${kind}`);

test("lines that changed, came and went are told apart", () => {
  assert.deepEqual(marked("abc", "abc"), []);
  assert.deepEqual(marked("abc", "aXc"), ["2 changed"]);
  assert.deepEqual(marked("abc", "abXYc"), ["3 added", "4 added"]);
  assert.deepEqual(marked("abcd", "ad"), ["2 removed"]);
  assert.deepEqual(marked("abc", "ab"), ["2 removed"]);
  assert.deepEqual(marked("abcdef", "aXcdYZf"), ["2 changed", "5 changed", "6 added"]);
});

test("two long texts with little in common are compared all the same, quickly", () => {
  const before = Array.from({ length: 9000 }, (_, n) => `old ${n}`);
  const now = before.map((line, n) => (n % 2 ? line : `new ${n}`));
  assert.equal(changedLines(before, now).length, 4500);
  assert.equal(changedLines(before, [...now, "x"]).length, 9001);
});
