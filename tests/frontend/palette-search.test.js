/** @import { Ranked } from "../../frontend_assets/lib/ranking.js" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { fitting, readSearch, sectionsOf } from "../../frontend_assets/app/palette.js";

/** @param {Ranked["rank"]} rank @param {string} label @returns {Ranked} */
const one = (rank, label) => ({ rank, label });

test("a line, and a column, may be asked for behind the name of a file or alone", () => {
  assert.deepEqual(readSearch("arm.xacro:120"), {
    kinds: null,
    words: "arm.xacro",
    line: 120,
    column: 1,
  });
  assert.deepEqual(readSearch(":7:3"), { kinds: null, words: "", line: 7, column: 3 });
  assert.equal(readSearch("a:b").line, 0);
  assert.equal(readSearch("arm:99999999999999999999").line, 0);
});

test("a sign at the start asks for some kinds only", () => {
  const all = [one("command", "Save"), one("link", "save_link"), one("joint", "save_joint")];
  const names = (/** @type {string} */ text) =>
    fitting(all, readSearch(text)).map(({ label }) => label);
  assert.deepEqual(names("save"), ["Save", "save_link", "save_joint"]);
  assert.deepEqual(names("@ save"), ["save_link", "save_joint"]);
  assert.deepEqual(names(">"), ["Save"]);
});

test("each kind is a section in the order of its best, and says how many it leaves out", () => {
  const found = [one("link", "a"), one("file", "b"), one("link", "c"), one("link", "d")];
  assert.deepEqual(sectionsOf(found, 2), [
    { heading: "link", choices: [found[0], found[2]], more: 1 },
    { heading: "file", choices: [found[1]], more: 0 },
  ]);
});
