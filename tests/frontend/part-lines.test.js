import assert from "node:assert/strict";
import { test } from "node:test";
import { lineOfPart } from "../../frontend_assets/panels/source/selection.js";

/** @param {string[]} texts */
const doc = (...texts) => ({
  lines: texts.length,
  line: (/** @type {number} */ number) => ({ text: texts[number - 1] ?? "" }),
});

/** @param {string} kind @param {string} name @param {number} line */
const part = (kind, name, line) => ({ kind, name, line });

test("a part is where it was, or where its name is now", () => {
  const lines = doc("<robot>", '  <link name="a"/>', "  <link name='b'>", '<joint name="b">');
  assert.equal(lineOfPart(lines, part("link", "a", 2)), 2);
  assert.equal(lineOfPart(lines, part("link", "b", 2)), 3);
  assert.equal(lineOfPart(lines, part("joint", "b", 1)), 4);
  assert.equal(lineOfPart(lines, part("link", "b", 99)), 3);
});

test("a name that a macro makes stays at its line", () => {
  const lines = doc('<link name="${side}_wheel">', '<link name="left_wheel"/>');
  assert.equal(lineOfPart(lines, part("link", "left_wheel", 1)), 1);
});

test("what is not in the text has no line", () => {
  assert.equal(lineOfPart(doc("<robot/>", "<links/>"), part("link", "a", 2)), 0);
  assert.equal(lineOfPart(doc(), part("link", "a", 1)), 0);
});

test("a name over several lines is found by its line", () => {
  assert.equal(lineOfPart(doc("<link", '  name="a"/>'), part("link", "a", 1)), 1);
});
