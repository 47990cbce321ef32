import assert from "node:assert/strict";
import { test } from "node:test";
import {
  addedDisplay,
  counts,
  firstTrouble,
  foundTopics,
  freeName,
  groupNames,
  inGroups,
  moveOfDisplay,
  moveOfGroup,
  rateWords,
  settingRows,
} from "../../frontend_assets/lib/live-displays.js";

/** A display of that id in a group. @param {string} id @param {string} [group] */
const display = (id, group = "") => /** @type {any} */ ({ id, group, name: id, kind: "Path" });

/** A property of that name. @param {string} name @param {object} [more] */
const property = (name, more) =>
  /** @type {any} */ ({ name, kind: "switch", default: true, when: "", when_values: [], ...more });

/** @param {string[]} ids @param {{display: string, before: string}[] | null} moves @returns {string[]} as the studio lists them then */
function after(ids, moves) {
  let now = ids;
  for (const { display: moved, before } of moves ?? []) {
    const others = now.filter((id) => id !== moved);
    const at = before === "" ? others.length : others.indexOf(before);
    now = [...others.slice(0, at), moved, ...others.slice(at)];
  }
  return now;
}

test("a group stands where its first member stands, with all members in it", () => {
  const entries = inGroups([display("a"), display("b", "Nav"), display("c"), display("d", "Nav")]);
  const shown = entries.map((one) =>
    "display" in one ? one.display.id : [one.group, ...one.members.map(({ id }) => id)],
  );
  assert.deepEqual(shown, ["a", ["Nav", "b", "d"], "c"]);
});

test("groups of any name are groups, also those that objects have as properties", () => {
  const displays = [display("a", "constructor"), display("b", "__proto__")];
  assert.deepEqual(groupNames(displays), ["constructor", "__proto__"]);
  assert.equal(inGroups(displays).length, 2);
});

test("a display goes up and down past what stands beside it, a group as one", () => {
  const list = [display("a"), display("b", "G"), display("c", "G"), display("d")];
  const ids = ["a", "b", "c", "d"];
  assert.deepEqual(after(ids, moveOfDisplay(list, "a", 1)), ["b", "c", "a", "d"]);
  assert.deepEqual(after(ids, moveOfDisplay(list, "d", -1)), ["a", "d", "b", "c"]);
  assert.deepEqual(after(ids, moveOfDisplay(list, "b", 1)), ["a", "c", "b", "d"]);
  assert.deepEqual(after(ids, moveOfGroup(list, "G", 1)), ["a", "d", "b", "c"]);
  assert.deepEqual(after(ids, moveOfGroup(list, "G", -1)), ["b", "c", "a", "d"]);
});

test("what stands at an end goes no further, and what is not there goes nowhere", () => {
  const list = [display("a"), display("b", "G")];
  assert.equal(moveOfDisplay(list, "a", -1), null);
  assert.equal(moveOfDisplay(list, "b", 1), null);
  assert.equal(moveOfGroup(list, "G", 1), null);
  assert.equal(moveOfDisplay(list, "x", 1), null);
});

test("a property counts while all that it depends on have the values for it", () => {
  const all = [
    property("Covariance"),
    property("Covariance/Position", { when: "Covariance", when_values: [true] }),
    property("Covariance/Position/Alpha", { when: "Covariance/Position", when_values: [true] }),
  ];
  const named = new Map(all.map((one) => [one.name, one]));
  const values = { Covariance: true, "Covariance/Position": true };
  const counting = (/** @type {Record<string, boolean>} */ now) =>
    all.filter((one) => counts(one, named, (name) => now[name])).length;
  assert.equal(counting(values), 3);
  assert.equal(counting({ ...values, "Covariance/Position": false }), 2);
  assert.equal(counting({ ...values, Covariance: false }), 1);
});

test("properties that depend on each other in a ring end", () => {
  const a = property("a", { when: "b", when_values: [true] });
  const b = property("b", { when: "a", when_values: [true] });
  const named = new Map([
    ["a", a],
    ["b", b],
  ]);
  assert.equal(
    counts(a, named, () => true),
    true,
  );
});

test("names with slashes make a tree of which only what is unfolded is shown", () => {
  const properties = ["Color", "Offset/X", "Offset/Y", "Alpha"].map((name) => property(name));
  const shut = settingRows(properties, () => false);
  assert.deepEqual(
    shut.map(({ path, folds }) => [path, folds]),
    [
      ["Color", false],
      ["Offset", true],
      ["Alpha", false],
    ],
  );
  const open = settingRows(properties, (path) => path === "Offset");
  assert.deepEqual(
    open.map(({ label, depth, property: own }) => [label, depth, own !== null]),
    [
      ["Color", 0, true],
      ["Offset", 0, false],
      ["X", 1, true],
      ["Y", 1, true],
      ["Alpha", 0, true],
    ],
  );
});

test("rates are short, and nothing is no rate", () => {
  assert.deepEqual([0, 0.96, 9.94, 30.4].map(rateWords), ["", "1.0 Hz", "9.9 Hz", "30 Hz"]);
});

test("that all is well is no trouble", () => {
  const remark = (/** @type {string} */ level) => ({ level, reason: "", sentence: "", mend: null });
  const state = (/** @type {string[]} */ ...levels) =>
    /** @type {any} */ ({ remarks: levels.map(remark) });
  assert.equal(firstTrouble(state("ok")), null);
  assert.equal(firstTrouble(undefined), null);
  assert.equal(firstTrouble(state("ok", "warn", "error"))?.level, "warn");
});

test("topics that a display shows come first, found by name, type or display", () => {
  const topic = (/** @type {string} */ name, /** @type {string} */ type, kind = "") => ({
    name,
    types: [type],
    publishers: 1,
    kind,
  });
  const topics = [
    topic("/rosout", "rcl_interfaces/msg/Log"),
    topic("/scan", "sensor_msgs/msg/LaserScan", "LaserScan"),
  ];
  const names = (/** @type {string} */ words) => foundTopics(topics, words).map(({ name }) => name);
  assert.deepEqual(names(""), ["/scan", "/rosout"]);
  assert.deepEqual(names("laser sensor"), ["/scan"]);
  assert.deepEqual(names("msg log"), ["/rosout"]);
  assert.deepEqual(names("nothing"), []);
});

test("a free name is none of those that are taken", () => {
  assert.equal(freeName(["Group 1", "Group 3"], "Group"), "Group 2");
});

test("one display that came was added by a person, several came with their robot", () => {
  const [a, b, c] = ["a", "b", "c"].map((id) => display(id));
  assert.equal(addedDisplay(null, [a]), undefined);
  assert.equal(addedDisplay(new Set(["a"]), [a, b]), b);
  assert.equal(addedDisplay(new Set(["a"]), [b, a]), b);
  assert.equal(addedDisplay(new Set(["a"]), [a, b, c]), undefined);
  assert.equal(addedDisplay(new Set(["a", "b"]), [a]), undefined);
});
