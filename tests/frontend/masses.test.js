/** @import { LinkMassView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import {
  centreOfMass,
  densityOf,
  isOddDensity,
  isPossible,
  massRows,
  massText,
  matchingMasses,
  sortedMasses,
  sumOf,
} from "../../frontend_assets/model/masses.js";

const ROVER = JSON.parse(
  readFileSync(new URL("../support/link-poses.json", import.meta.url), "utf8"),
);

/** @param {string} link @param {number} kg @param {Partial<LinkMassView>} [more] @returns {LinkMassView} */
const mass = (link, kg, more = {}) => ({
  link,
  mass_kg: kg,
  centre_m: [0, 0, 0],
  moments_kg_m2: [0.1, 0.2, 0.25],
  inertia_kg_m2: [0.1, 0, 0, 0.2, 0, 0.25],
  visual: null,
  collision: null,
  ...more,
});

/** @param {number} volume @param {boolean} [exact] */
const volume = (volume, exact = true) => ({ volume_m3: volume, is_exact: exact });

test("the centre of mass of a real robot is where the studio's own sum puts it", () => {
  const poses = new Map(Object.entries(ROVER.poses));
  const found = centreOfMass(ROVER.masses, /** @type {any} */ (poses));
  assert.ok(found);
  found.forEach((value, at) => {
    assert.ok(Math.abs(value - ROVER.centre[at]) < 1e-12);
  });
});

test("without mass, or before the poses are known, there is no centre", () => {
  assert.equal(centreOfMass([mass("a", 0)], new Map()), null);
  assert.equal(centreOfMass([mass("a", 1)], new Map()), null);
});

test("shares are of the sum, and what weighs less than nothing has none", () => {
  const rows = massRows([mass("a", 3), mass("b", 1), mass("c", -2)], []);
  assert.deepEqual(
    rows.map(({ share }) => share),
    [0.75, 0.25, 0],
  );
  assert.equal(sumOf(rows.map((row) => row.mass)), 4);
  assert.deepEqual(
    massRows([mass("a", 0)], []).map(({ share }) => share),
    [0],
  );
});

test("a density is that of the shapes whose volume is known for sure", () => {
  const both = { collision: volume(0.002, false), visual: volume(0.001) };
  assert.deepEqual(densityOf(mass("a", 2, both)), { kg_m3: 2000, isExact: true, of: "visual" });
  const open = densityOf(mass("a", 2, { collision: volume(0.002, false) }));
  assert.deepEqual(open, { kg_m3: 1000, isExact: false, of: "collision" });
  assert.equal(densityOf(mass("a", 2, { visual: volume(0) })), null);
});

test("too dense is odd even when it may be denser; too light only when that is sure", () => {
  const of = "visual";
  assert.equal(isOddDensity({ kg_m3: 1e5, isExact: false, of }), true);
  assert.equal(isOddDensity({ kg_m3: 1, isExact: false, of }), false);
  assert.equal(isOddDensity({ kg_m3: 1, isExact: true, of }), true);
  assert.equal(isOddDensity({ kg_m3: 2700, isExact: true, of }), false);
});

test("no body has a moment above the sum of the others, nor one below zero", () => {
  assert.equal(isPossible(mass("a", 1)), true);
  assert.equal(isPossible(mass("a", 1, { moments_kg_m2: [0.1, 0.2, 0.31] })), false);
  assert.equal(isPossible(mass("a", 1, { moments_kg_m2: [-0.1, 0.2, 0.2] })), false);
  assert.equal(isPossible(mass("a", 0)), false);
  assert.equal(isPossible(mass("a", 1, { moments_kg_m2: [0, 0, 0] })), false);
});

test("rows are sorted by what is asked, and stay in the robot's order else", () => {
  const rows = massRows([mass("b", 1), mass("a", 5), mass("c", 3, { visual: volume(0.001) })], []);
  const names = (/** @type {import("../../frontend_assets/model/masses.js").MassOrder} */ order) =>
    sortedMasses(rows, order).map((row) => row.mass.link);
  assert.deepEqual(names("link"), ["b", "a", "c"]);
  assert.deepEqual(names("mass"), ["a", "c", "b"]);
  assert.deepEqual(names("density"), ["c", "b", "a"]);
  assert.deepEqual(
    matchingMasses(rows, " A ").map((row) => row.mass.link),
    ["a"],
  );
});

test("copied cells hold all digits, and no name becomes a cell, a line or a formula", () => {
  const names = ['wheel, "left"', "=1+1", "tab\there"];
  const rows = massRows(
    names.map((name) => mass(name, 1 / 3)),
    [],
  );
  const csv = massText(rows, "csv").split("\n");
  assert.ok(csv[1]?.startsWith('"wheel, ""left""",0.3333333333333333,'));
  assert.ok(csv[2]?.startsWith("'=1+1,"));
  const tsv = massText(rows, "tsv").slice(0, -1).split("\n");
  const cells = tsv.map((line) => line.split("\t").length);
  assert.deepEqual(new Set(cells), new Set([cells[0]]));
});
