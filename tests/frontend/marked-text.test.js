import assert from "node:assert/strict";
import { test } from "node:test";
import { drawnLines, markedTexts } from "../../frontend_assets/lib/text-differences.js";

/** @param {import("../../frontend_assets/lib/text-differences.js").Piece[]} pieces */
const spelled = (pieces) =>
  pieces.map(({ text, marked }) => (marked ? `[${text}]` : text)).join("");

/** @param {string} before @param {string} now */
const marked = (before, now) => {
  const found = markedTexts(before, now);
  return [spelled(found.before), spelled(found.now)];
};

test("a changed number is marked whole in both texts", () => {
  assert.deepEqual(marked('<box size="0.1 1"/>', '<box size="0.15 1"/>'), [
    '<box size="[0.1] 1"/>',
    '<box size="[0.15] 1"/>',
  ]);
});

test("what stands between two changes is not marked", () => {
  assert.deepEqual(marked("a b c d", "x b c y"), ["[a] b c [d]", "[x] b c [y]"]);
});

test("equal texts have no mark, and a text that came is all marked", () => {
  assert.deepEqual(marked("a b", "a b"), ["a b", "a b"]);
  assert.deepEqual(marked("", "new words"), ["", "[new words]"]);
});

test("letters beyond ASCII and emoji stay whole", () => {
  assert.deepEqual(marked("größe 🤖", "grösse 🤖"), ["[größe] 🤖", "[grösse] 🤖"]);
});

test("two texts too long to be compared are marked between what both begin and end with", () => {
  const [old, fresh] = ["a ", "b "].map((word) => `start ${word.repeat(400)}end`);
  const [before] = marked(old ?? "", fresh ?? "");
  assert.equal(before, `start [${"a ".repeat(400).trimEnd()}] end`);
});

/** @type {(kind: "same" | "old" | "new", text: string) => import("../../frontend_assets/types/wire.d.ts").DiffLineView} */
const line = (kind, text) => ({ kind, before: 1, after: 1, text });

test("lines that replace each other are compared one by one, in their order", () => {
  const drawn = drawnLines([
    line("same", "x"),
    line("old", "a 1"),
    line("old", "b 2"),
    line("new", "a 3"),
    line("same", "y"),
    line("new", "came"),
  ]);
  assert.deepEqual(
    drawn.map(({ kind, pieces }) => `${kind} ${spelled(pieces)}`),
    ["same x", "old a [1]", "old b 2", "new a [3]", "same y", "new came"],
  );
});
