import assert from "node:assert/strict";
import { test } from "node:test";
import {
  addedDisplay,
  counts,
  firstTrouble,
  foundTopics,
  rateWords,
  settingRows,
  statusesOf,
  worstOf,
} from "../../frontend_assets/lib/live-displays.js";

/** A display of that id in a group. @param {string} id @param {string} [group] */
const display = (id, group = "") => /** @type {any} */ ({ id, group, name: id, kind: "Path" });

/** A property of that name. @param {string} name @param {object} [more] */
const property = (name, more) =>
  /** @type {any} */ ({ name, kind: "switch", default: true, when: "", when_values: [], ...more });

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
    kinds: kind ? [kind] : [],
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

test("what is in the way of a display comes before what is well, and the worst colours its row", () => {
  const remark = (/** @type {string} */ level, /** @type {string} */ reason) => ({
    level,
    reason,
    sentence: reason,
    mend: null,
  });
  /** @param {number} received @param {[string, string][]} remarks */
  const told = (received, ...remarks) =>
    statusesOf(
      /** @type {any} */ ({ received, remarks: remarks.map((one) => remark(...one)) }),
      true,
    ).map(({ name, level }) => `${name} ${level}`);
  assert.deepEqual(told(7, ["ok", ""]), ["topic ok", "transform ok"]);
  assert.deepEqual(told(7, ["error", "no_frame"], ["warn", "transparent"]), [
    "transform error",
    "message warn",
    "topic ok",
  ]);
  assert.deepEqual(told(0, ["warn", "no_message"]), ["topic warn"]);
  assert.deepEqual(told(9, ["warn", "silent"]), ["topic warn", "transform ok"]);
  assert.deepEqual(told(0, ["warn", "group_off"]), ["group warn"]);
  assert.deepEqual(told(0), []);
  assert.equal(worstOf(["ok", "error", "warn"]), "error");
  assert.equal(worstOf([]), "ok");
});

test("one display that came was added by a person, several came with their robot", () => {
  const [a, b, c] = ["a", "b", "c"].map((id) => display(id));
  assert.equal(addedDisplay(null, [a]), undefined);
  assert.equal(addedDisplay(new Set(["a"]), [a, b]), b);
  assert.equal(addedDisplay(new Set(["a"]), [b, a]), b);
  assert.equal(addedDisplay(new Set(["a"]), [a, b, c]), undefined);
  assert.equal(addedDisplay(new Set(["a", "b"]), [a]), undefined);
});
