/** @import { DifferenceView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  changeText,
  endOf,
  grouped,
  matching,
  partOf,
  rowLabel,
  shownUnit,
  sorted,
  valueText,
} from "../../frontend_assets/panels/variants/comparison.js";

/** @param {Partial<DifferenceView>} given @returns {DifferenceView} */
const row = (given) => ({
  part: "link:base",
  what: "mass",
  number: 0,
  one: 1,
  other: 2,
  unit: "kg",
  delta: 1,
  percent: 100,
  ...given,
});

test("a part is a kind and a name, whatever the name holds", () => {
  assert.deepEqual(partOf("link:a:b"), { kind: "link", name: "a:b" });
  assert.deepEqual(partOf("robot"), { kind: "robot", name: "" });
});

test("a label says which shape and which of its measures", () => {
  const word = (/** @type {string} */ key) => (key === "visual" ? "Visual" : key);
  assert.equal(rowLabel(row({ what: "visual.size.x", number: 2 }), word), "Visual 2 size x");
  assert.equal(rowLabel(row({ what: "mass" }), word), "Mass");
});

test("angles are told in the unit of the person", () => {
  assert.deepEqual(shownUnit("rad", false), { unit: "rad", factor: 1 });
  assert.deepEqual(shownUnit("rad/s", true), { unit: "°/s", factor: 180 / Math.PI });
  assert.deepEqual(shownUnit("kg m^2", true), { unit: "kg m²", factor: 1 });
});

test("a value that one robot lacks is empty, a text is itself", () => {
  assert.equal(valueText(null, 1), "");
  assert.equal(valueText("box", 57), "box");
  assert.equal(valueText(0.1 + 0.2, 1), "0.3");
});

test("of two paths the ends that differ are told", () => {
  assert.equal(endOf("package://a/ur5e/base.dae", "package://a/ur10e/base.dae"), "ur5e/base.dae");
  assert.equal(endOf("package://a/one.stl", null), "package://a/one.stl");
  assert.equal(endOf("a/b", "a/b/c"), "b");
});

test("a change has a sign, and per cent where there is something to compare with", () => {
  assert.deepEqual(changeText(row({ delta: 0.015, percent: 14.2857 }), 1), {
    delta: "+0.015",
    percent: "+14.3\u00a0%",
    whole: "+0.015 +14.2857\u00a0%",
  });
  assert.deepEqual(changeText(row({ delta: -2, percent: null }), 2), {
    delta: "−4",
    percent: "",
    whole: "−4",
  });
  assert.deepEqual(changeText(row({ delta: -1 / 3, percent: null }), 1), {
    delta: "−0.333333",
    percent: "",
    whole: "−0.333333333333333",
  });
  assert.deepEqual(changeText(row({ delta: null, percent: null }), 1), {
    delta: "",
    percent: "",
    whole: "",
  });
});

test("all words of the filter must be in the part or the label", () => {
  const rows = [row({ part: "link:wheel" }), row({ part: "joint:wheel", what: "origin.x" })];
  const label = (/** @type {DifferenceView} */ one) => one.what;
  assert.deepEqual(matching(rows, "WHEEL mass", label), [rows[0]]);
  assert.deepEqual(matching(rows, " ", label), rows);
});

test("what came or went is first, then the largest change", () => {
  const came = row({ one: null, delta: null, percent: null });
  const small = row({ delta: 5, percent: 1 });
  const large = row({ delta: -0.5, percent: -50 });
  const text = row({ one: "a", other: "b", delta: null, percent: null });
  const fromZero = row({ one: 0, delta: 0.1, percent: null });
  const rows = [small, text, large, fromZero, came];
  assert.deepEqual(sorted(rows, "share"), [came, text, fromZero, large, small]);
  assert.deepEqual(sorted(rows, "size"), [came, text, small, large, fromZero]);
  assert.deepEqual(sorted(rows, "part"), rows);
});

test("neighbours of one part stand together", () => {
  const rows = [row({}), row({ what: "ixx" }), row({ part: "joint:a" })];
  assert.deepEqual(
    grouped(rows).map(({ part, rows: those }) => [part, those.length]),
    [
      ["link:base", 2],
      ["joint:a", 1],
    ],
  );
});
