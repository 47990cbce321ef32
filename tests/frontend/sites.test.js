import assert from "node:assert/strict";
import { test } from "node:test";
import {
  countKinds,
  groupSites,
  isChanged,
  names,
  shortName,
} from "../../frontend_assets/lib/sites.js";

/** @import { SiteView } from "../../frontend_assets/types/wire.d.ts" */

/** @param {string} id @param {Partial<SiteView>} [more] @returns {SiteView} */
const site = (id, more = {}) => ({
  id,
  kind: "property",
  name: id,
  file: "a.xacro",
  line: 1,
  text: "1",
  saved_text: null,
  value: "1",
  number: 1,
  values: [],
  reads: 1,
  widget: {
    kind: "slider",
    minimum: null,
    maximum: null,
    step: null,
    unit: "",
    choices: [],
    help: "",
    annotated: false,
  },
  group: "",
  owner: "",
  argument: null,
  ...more,
});

const SITES = new Map(
  [
    site("wheel_radius", { group: "Wheels" }),
    site("mast", { file: "b.xacro" }),
    site("wheel_width", { group: "Wheels" }),
    site("arm", { kind: "arg" }),
    site("box @size", { kind: "literal", owner: "link:base" }),
  ].map((one) => [one.id, one]),
);
const ORDER = [...SITES.keys()];
const KINDS = new Set(["arg", "property"]);

/** @param {ReturnType<typeof groupSites>} groups */
const shown = (groups) => groups.map(({ file, group, sites }) => [file, group, ...sites]);

test("sites stand under their file and heading, in the order of the studio", () => {
  const groups = groupSites(ORDER, SITES, { words: "", kinds: KINDS, chosen: null });
  assert.deepEqual(shown(groups), [
    ["a.xacro", "Wheels", "wheel_radius", "wheel_width"],
    ["a.xacro", "", "arm"],
    ["b.xacro", "", "mast"],
  ]);
});

test("all words of the filter must be found, in name, heading, text or help", () => {
  const groups = groupSites(ORDER, SITES, { words: "WHEELS rad", kinds: KINDS, chosen: null });
  assert.deepEqual(shown(groups), [["a.xacro", "Wheels", "wheel_radius"]]);
});

test("what shapes a link is found whatever its kind", () => {
  const groups = groupSites(ORDER, SITES, {
    words: "",
    kinds: KINDS,
    chosen: new Set(["box @size"]),
  });
  assert.deepEqual(shown(groups), [["a.xacro", "", "box @size"]]);
});

test("an id that is in the order but not yet known is left out", () => {
  const groups = groupSites(["ghost", "arm"], SITES, { words: "", kinds: KINDS, chosen: null });
  assert.deepEqual(shown(groups), [["a.xacro", "", "arm"]]);
});

test("a site is changed only while the file on disk says something else", () => {
  assert.equal(isChanged(site("a")), false);
  assert.equal(isChanged(site("a", { saved_text: "2" })), true);
  assert.equal(isChanged(site("a", { saved_text: "1" })), false);
});

test("kinds are counted as they occur", () => {
  assert.deepEqual(Object.fromEntries(countKinds(ORDER, SITES)), {
    property: 3,
    arg: 1,
    literal: 1,
  });
});

test("a path is not said twice, in the heading and in the name", () => {
  assert.equal(shortName(site("limits.pan.max", { group: "limits.pan" })), "max");
  assert.equal(shortName(site("limits.panning", { group: "limits.pan" })), "limits.panning");
  assert.equal(shortName(site("limits", { group: "" })), "limits");
});

test("a sentence names a property by its whole name only", () => {
  for (const sentence of [
    '"wheel" is not defined',
    "wheel: no number.",
    "of ${wheel}",
    "see wheel.",
  ])
    assert.ok(names(sentence, "wheel"), sentence);
  for (const sentence of [
    '"wheel_radius" is not defined',
    "front_wheel: no number.",
    "arm.wheel",
    "wheel.radius",
    "räwheel",
    "wheel-2",
    "",
  ])
    assert.ok(!names(sentence, "wheel"), sentence);
  assert.ok(names("wheel_radius is twice wheel", "wheel"));
  assert.ok(!names("anything", ""));
});
