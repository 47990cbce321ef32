import { wordsOf } from "./support/words.js";

/** @import { Problem } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { changedLines, hunkAt, oneChange } from "../../frontend_assets/lib/text-differences.js";
import {
  asText,
  byFile,
  counts,
  filtered,
  keyOf,
  mendable,
} from "../../frontend_assets/panels/problems/problems.js";

/** @param {Problem["severity"]} severity @param {string} sentence @param {Partial<Problem>} [more] @returns {Problem} */
const problem = (severity, sentence, more = {}) => ({
  severity,
  code: "odd",
  sentence,
  place: null,
  include_chain: [],
  macro_stack: [],
  fix: null,
  parts: [],
  ...more,
});
const at = (/** @type {string} */ file, /** @type {number} */ line) => ({
  place: { file, line, column: 3 },
});
const edit = { label: "Mend", action: "edit", target: "", edits: [], new_files: [] };
const LIST = [
  problem("info", "Unused.", at("/a.xacro", 2)),
  problem("warning", "Heavy wheel.", { ...at("/b.xacro", 9), fix: edit }),
  problem("error", "No root."),
  problem("error", "Broken tag.", { ...at("/b.xacro", 12), fix: edit }),
];

test("problems stand by file, the worst first, and in a file by weight", () => {
  const files = byFile(LIST);
  assert.deepEqual(
    files.map(({ file }) => file),
    ["", "/b.xacro", "/a.xacro"],
  );
  assert.deepEqual(
    files[1]?.problems.map(({ sentence }) => sentence),
    ["Broken tag.", "Heavy wheel."],
  );
});

test("a filter takes words anywhere in a problem, and kinds away", () => {
  assert.equal(filtered(LIST, "wheel b.xacro", new Set()).length, 1);
  assert.equal(filtered(LIST, "b.xacro:12", new Set()).length, 1);
  assert.equal(filtered(LIST, "", new Set(["error"])).length, 2);
  assert.equal(filtered(LIST, "nothing like it", new Set()).length, 0);
});

test("what an edit mends is counted, notes aside", () => {
  assert.deepEqual(counts(LIST), { error: 2, warning: 1, info: 1 });
  assert.equal(mendable(LIST), 2);
  assert.equal(mendable([problem("info", "x", { fix: edit })]), 0);
});

test("as text each problem is a line that an editor can follow", () => {
  const lines = asText(byFile(LIST), (one) => one).split("\n");
  assert.equal(lines[0], "error: No root. [odd]");
  assert.equal(lines[1], "/b.xacro:12:3: error: Broken tag. [odd]");
});

test("a problem keeps its key while others come and go", () => {
  assert.equal(keyOf(problem("error", "No root.")), keyOf(LIST[2] ?? problem("info", "")));
  assert.notEqual(
    keyOf(problem("error", "No root.", at("/c", 1))),
    keyOf(problem("error", "No root.")),
  );
});

/** @param {string} text */
const lines = (text) => text.split("");

for (const [before, now] of [
  ["abcdef", "abXdef"],
  ["abcdef", "abdef"],
  ["abcdef", "abcXYdef"],
  ["abc", "Xabc"],
  ["abc", "ab"],
  ["abc", ""],
  ["", "abc"],
  ["abcabc", "bcXab"],
]) {
  test(`every mark of ${before} to ${now} leads to lines that put it back`, () => {
    const [old, text] = [lines(before ?? ""), lines(now ?? "")];
    let [left, rounds] = [text, 0];
    for (let [mark] = changedLines(old, left); mark; [mark] = changedLines(old, left)) {
      const hunk = hunkAt(old, left, mark.line);
      assert.ok(hunk, `no hunk at ${mark.line} of ${left.join("")}`);
      const back = old.slice(hunk.oldFrom - 1, hunk.oldTo - 1);
      left = [...left.slice(0, hunk.from - 1), ...back, ...left.slice(hunk.to - 1)];
      rounds += 1;
      assert.ok(rounds < 10);
    }
    assert.deepEqual(left, old);
  });
}

test("one change makes one text of another", () => {
  for (const [before, now] of [
    ["same", "same"],
    ["aXb", "ab"],
    ["ab", "aXb"],
    ["aaa", "aa"],
    ["", "x"],
  ]) {
    const { from, to, insert } = oneChange(before ?? "", now ?? "");
    assert.equal((before ?? "").slice(0, from) + insert + (before ?? "").slice(to), now);
  }
});

/** Where the checks are that name their findings by codes. */
const CHECKS = ["robot/checks", "description/checks", "robot/structure.py", "documents/checks"];
const READERS = ["recovery.py", "broken_tags.py"];

/** @param {string} path below studio/ @returns {string[]} the sources there */
function sourcesAt(path) {
  const url = new URL(`../../studio/${path}`, import.meta.url);
  if (path.endsWith(".py")) return [readFileSync(url, "utf8")];
  return readdirSync(url)
    .filter((name) => name.endsWith(".py"))
    .map((name) => readFileSync(new URL(`${url}/${name}`), "utf8"));
}

test("every code that a check gives a finding has its why", () => {
  const words = wordsOf("en");
  const sources = [...CHECKS, ...READERS.map((name) => `description/syntax/${name}`)]
    .flatMap(sourcesAt)
    .join("\n");
  const codes = new Set(
    [...sources.matchAll(/(?<![\w.=>])"([a-z]+(?:-[a-z]+)+)"/g)].map(([, code]) => code ?? ""),
  );
  for (const code of ["cycle", "unused-property", "unused-arg"]) codes.add(code);
  assert.ok(codes.size > 40, `only ${codes.size} codes were found`);
  // Checks explain their codes themselves; what readers refuse is explained by the page.
  const explained = [...sources.matchAll(/"([a-z-]+)": \{\s*"en": ["'][^"']+/g)];
  const own = new Set(explained.map(([, code]) => code));
  assert.ok(own.size >= 31, `only ${own.size} explanations were found`);
  const silent = [...codes].filter((code) => !own.has(code) && !(`why.${code}` in words));
  assert.deepEqual(silent, []);
});
