import assert from "node:assert/strict";
import { test } from "node:test";
import {
  dropOn,
  freeName,
  groupPaths,
  groupsTo,
  inGroups,
  intoMove,
  inwardMove,
  outwardMove,
  stepMove,
} from "../../frontend_assets/lib/display-groups.js";

/** @import { Entry, Move } from "../../frontend_assets/lib/display-groups.js" */

/** "a b/G c/G/H d": four displays, one in a group and one in a group of that. @param {string} text @returns {any[]} */
const listed = (text) =>
  text.split(" ").map((word) => {
    const [id = "", ...groups] = word.split("/");
    return { id, group: groups.join("/") };
  });

/** @param {any[]} displays @returns {string} */
const text = (displays) =>
  displays.map(({ id, group }) => (group ? `${id}/${group}` : id)).join(" ");

/** As the studio lists them after a move. @param {string} before @param {Move | null | undefined} move */
function moved(before, move) {
  if (!move) return null;
  const now = listed(before);
  const own = "display" in move ? null : (move.group ?? "");
  const isMoved = (/** @type {any} */ one) =>
    own === null
      ? "display" in move && one.id === move.display
      : one.group === own || one.group.startsWith(`${own}/`);
  const others = now.filter((one) => !isMoved(one));
  const at = move.before === "" ? others.length : others.findIndex(({ id }) => id === move.before);
  assert.notEqual(at, -1, `${move.before} is there`);
  const put = now.filter(isMoved).map(({ id, group }) => ({
    id,
    group: "to" in move ? `${move.to}${group.slice(own?.length)}` : (move.group ?? group),
  }));
  return text(others.toSpliced(at, 0, ...put));
}

/** @param {string} list @param {string} dragged @param {string} target @param {number} share */
const after = (list, dragged, target, share) =>
  moved(list, dropOn(listed(list), dragged, target, share)?.move);

test("a group stands where its first member stands, with all that is in it", () => {
  /** @type {(entry: Entry) => unknown} */
  const shown = (entry) =>
    "display" in entry ? entry.display.id : [entry.group, ...entry.entries.map(shown)];
  assert.deepEqual(inGroups(listed("a b/N/L c d/N e/N/L f")).map(shown), [
    "a",
    ["N", ["N/L", "b", "e"], "d"],
    "c",
    "f",
  ]);
  assert.deepEqual(groupPaths(listed("a/N/L b/M c/N")), ["N", "N/L", "M"]);
  assert.deepEqual(groupsTo("N/L/X"), ["N", "N/L", "N/L/X"]);
});

test("groups of any name are groups, also those that objects have as properties", () => {
  const displays = listed("a/constructor b/__proto__");
  assert.deepEqual(groupPaths(displays), ["constructor", "__proto__"]);
  assert.equal(inGroups(displays).length, 2);
});

test("a display goes up and down past what stands beside it, a group as one", () => {
  const list = "a b/G c/G d";
  const step = (/** @type {string} */ row, /** @type {1 | -1} */ by) =>
    moved(list, stepMove(listed(list), row, by));
  assert.equal(step("display:a", 1), "b/G c/G a d");
  assert.equal(step("display:d", -1), "a d b/G c/G");
  assert.equal(step("display:b", 1), "a c/G b/G d");
  assert.equal(step("group:G", 1), "a d b/G c/G");
  assert.equal(step("group:G", -1), "b/G c/G a d");
});

test("what stands at an end goes no further, and what is not there goes nowhere", () => {
  const list = listed("a b/G");
  for (const row of ["display:b", "group:G", "display:x", "group:x", "link:a"])
    assert.equal(stepMove(list, row, 1), null);
  assert.equal(stepMove(list, "display:a", -1), null);
});

test("a group in a group goes up and down in it", () => {
  const list = "a/G b/G/H c/G/H d/G e";
  assert.equal(moved(list, stepMove(listed(list), "group:G/H", -1)), "b/G/H c/G/H a/G d/G e");
  assert.equal(moved(list, stepMove(listed(list), "group:G/H", 1)), "a/G d/G b/G/H c/G/H e");
  assert.equal(moved(list, stepMove(listed(list), "display:d", -1)), "a/G d/G b/G/H c/G/H e");
});

test("by keys what stands below a group goes into it, and out of it again", () => {
  const list = "a/G b c/H";
  assert.equal(moved(list, inwardMove(listed(list), "display:b")), "a/G b/G c/H");
  assert.equal(inwardMove(listed(list), "group:H"), null);
  assert.equal(moved("a/G c/H", inwardMove(listed("a/G c/H"), "group:H")), "a/G c/G/H");
  assert.equal(moved("a/G b/G/H c", outwardMove(listed("a/G b/G/H c"), "group:G/H")), "a/G b/H c");
  assert.equal(moved("a/G b/G c", outwardMove(listed("a/G b/G c"), "display:a")), "b/G a c");
  assert.equal(moved("a/G c", outwardMove(listed("a/G c"), "display:a")), "a c");
  assert.equal(outwardMove(listed(list), "display:b"), null);
});

test("a group of the same name stays another group", () => {
  const list = "a/G b/H/G c";
  assert.equal(moved(list, outwardMove(listed(list), "group:H/G")), "a/G b/G 1 c");
  assert.equal(freeName(["Group 1", "Group 3"], "Group"), "Group 2");
});

test("what goes into a group by the menu is its last, and into a new one where it stands", () => {
  const list = "a b/G c/G d";
  assert.equal(moved(list, intoMove(listed(list), "display:a", "G")), "b/G c/G a/G d");
  assert.equal(moved(list, intoMove(listed(list), "display:a", "New")), "a/New b/G c/G d");
  assert.equal(moved(list, intoMove(listed(list), "display:b", "")), "b c/G d".replace("b", "a b"));
  assert.equal(moved(list, intoMove(listed(list), "group:G", "New")), "a b/New/G c/New/G d");
});

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
  assert.equal(after("a b c", "display:c", "status:a:well", 0.1), "a c b");
});

test("a group goes as a whole, keeps its order, and goes into others", () => {
  assert.equal(after("a b/G c/G d", "group:G", "display:a", 0.2), "b/G c/G a d");
  assert.equal(after("a b/G c/G d", "group:G", "display:d", 0.8), "a d b/G c/G");
  assert.equal(after("a/H b/G c/G", "group:G", "group:H", 0.9), "a/H b/H/G c/H/G");
  assert.equal(after("a/H b/G c/G", "group:G", "display:a", 0.2), "b/H/G c/H/G a/H");
  assert.equal(after("a/H b/H/G c", "group:H/G", "display:c", 0.9), "a/H c b/G");
});

test("nothing is dropped on itself, nor on what is no live display", () => {
  for (const target of ["display:a", "setting:a:Alpha", "robot", "link:base", "grid", "group:none"])
    assert.equal(after("a b", "display:a", target, 0.5), null);
  assert.equal(after("a/G b", "group:G", "display:a", 0.5), null);
  assert.equal(after("a/G b/G/H c", "group:G", "group:G/H", 0.5), null);
  assert.equal(after("a/G b", "display:a", "group:G", 0.5), null);
  assert.equal(after("a b", "display:gone", "display:a", 0.5), null);
});

test("it says where it would come to stand", () => {
  const where = (/** @type {number} */ share) =>
    dropOn(listed("a b/G"), "display:a", "group:G", share)?.where;
  assert.deepEqual([where(0.1), where(0.5), where(0.9)], ["before", "into", "into"]);
  assert.equal(dropOn(listed("a b"), "display:a", "display:b", 0.9)?.where, "after");
});
