import assert from "node:assert/strict";
import { test } from "node:test";
import { dropOn } from "../../frontend_assets/lib/live-displays.js";

/** "a b/G c/G d": four displays, two of them in a group. @param {string} text @returns {any[]} */
const listed = (text) =>
  text.split(" ").map((word) => {
    const [id = "", group = ""] = word.split("/");
    return { id, group };
  });

/** As the studio lists them after a drop. @param {string} text @param {string} dragged @param {string} target @param {number} share */
function after(text, dragged, target, share) {
  const drop = dropOn(listed(text), dragged, target, share);
  if (!drop) return null;
  let now = listed(text);
  for (const { display, before, group } of drop.moves) {
    const moved = now.find(({ id }) => id === display);
    const others = now.filter((one) => one !== moved);
    const at = before === "" ? others.length : others.findIndex(({ id }) => id === before);
    assert.notEqual(at, -1, `${before} is there`);
    now = others.toSpliced(at, 0, { ...moved, group: group ?? moved.group });
  }
  return now.map(({ id, group }) => (group ? `${id}/${group}` : id)).join(" ");
}

test("a display is dropped above and below others", () => {
  assert.equal(after("a b c", "display:c", "display:a", 0.2), "c a b");
  assert.equal(after("a b c", "display:a", "display:b", 0.8), "b a c");
  assert.equal(after("a b c", "display:a", "display:c", 0.8), "b c a");
  assert.equal(after("a b c", "display:b", "display:a", 0.8), "a b c");
});

test("a display goes into a group by its row, and to a place in it by its members", () => {
  assert.equal(after("a b/G c/G d", "display:a", "group:G", 0.6), "b/G c/G a/G d");
  assert.equal(after("a b/G c/G d", "display:d", "display:c", 0.2), "a b/G d/G c/G");
  assert.equal(after("a b/G c/G d", "display:a", "display:c", 0.8), "b/G c/G a/G d");
});

test("a display leaves its group above the group, and beside one that is in none", () => {
  assert.equal(after("a b/G c/G d", "display:c", "group:G", 0.1), "a c b/G d");
  assert.equal(after("a b/G c/G d", "display:b", "display:a", 0.2), "b a c/G d");
  assert.equal(after("a b/G c/G d", "display:b", "display:d", 0.8), "a c/G d b");
});

test("below a display means below it and above the group that follows, however members lie", () => {
  assert.equal(after("x a b/G c d/G", "display:x", "display:a", 0.9), "a x b/G c d/G");
  assert.equal(after("x b/G a d/G c", "display:x", "display:a", 0.9), "b/G a d/G x c");
});

test("what stands below a display counts as the place below it", () => {
  assert.equal(after("a b c", "display:c", "setting:a:Alpha", 0.1), "a c b");
  assert.equal(after("a b c", "display:c", "remark:a", 0.1), "a c b");
});

test("a group goes as a whole, keeps its order, and goes into no other", () => {
  assert.equal(after("a b/G c/G d", "group:G", "display:a", 0.2), "b/G c/G a d");
  assert.equal(after("a b/G c/G d", "group:G", "display:d", 0.8), "a d b/G c/G");
  assert.equal(after("a/H b/G c/G", "group:G", "group:H", 0.9), "b/G c/G a/H");
  assert.equal(after("a/H b/G c/G", "group:G", "display:a", 0.9), null);
});

test("nothing is dropped on itself, nor on what is no live display", () => {
  for (const target of ["display:a", "setting:a:Alpha", "robot", "link:base", "grid", "group:none"])
    assert.equal(after("a b", "display:a", target, 0.5), null);
  assert.equal(after("a/G b", "group:G", "display:a", 0.5), null);
  assert.equal(after("a/G b", "display:a", "group:G", 0.5), null);
  assert.equal(after("a b", "display:gone", "display:a", 0.5), null);
});

test("it says where it would come to stand", () => {
  const where = (/** @type {number} */ share) =>
    dropOn(listed("a b/G"), "display:a", "group:G", share)?.where;
  assert.deepEqual([where(0.1), where(0.5), where(0.9)], ["before", "into", "into"]);
  assert.equal(dropOn(listed("a b"), "display:a", "display:b", 0.9)?.where, "after");
});
