import assert from "node:assert/strict";
import { test } from "node:test";
import { marksOf, ranked } from "../../frontend_assets/lib/ranking.js";

/** @import { Ranked } from "../../frontend_assets/lib/ranking.js" */

/** @param {Ranked["rank"]} rank @param {string} label @returns {Ranked} */
const one = (rank, label) => ({ rank, label });

/** @param {Ranked[]} all @param {string} text @returns {string[]} */
const labels = (all, text) => ranked(all, text).map(({ label }) => label);

test("numbers without a name come after all that has one", () => {
  const all = [
    one("literal", "Go to property: link mast origin xyz"),
    one("property", "Go to property: my_link_length"),
    one("command", "Copy link"),
    one("link", "Go to link: arm"),
  ];
  assert.deepEqual(labels(all, "link"), [
    "Copy link",
    "Go to link: arm",
    "Go to property: my_link_length",
    "Go to property: link mast origin xyz",
  ]);
});

test("of what has a name, that which begins with the word comes first", () => {
  const all = [
    one("link", "Go to link: frontwheel"),
    one("property", "Go to property: wheel_radius"),
    one("file", "Go to file: urdf/wheel.xacro"),
  ];
  assert.deepEqual(labels(all, "wheel"), [
    "Go to property: wheel_radius",
    "Go to file: urdf/wheel.xacro",
    "Go to link: frontwheel",
  ]);
});

test("every word must occur, in any case and order", () => {
  const all = [one("command", "Theme: dark"), one("command", "Theme: light")];
  assert.deepEqual(labels(all, "DARK the"), ["Theme: dark"]);
  assert.deepEqual(labels(all, "dark light"), []);
});

test("signs of patterns are only signs, and umlauts are letters", () => {
  const all = [one("command", "Rückgängig"), one("file", "Go to file: a+(b).xacro")];
  assert.deepEqual(labels(all, "rück"), ["Rückgängig"]);
  assert.deepEqual(labels(all, "a+("), ["Go to file: a+(b).xacro"]);
  assert.deepEqual(labels(all, "[.*"), []);
});

test("nothing asked leaves the order as it is", () => {
  const all = [one("file", "b"), one("command", "a")];
  assert.deepEqual(labels(all, "  "), ["b", "a"]);
});

test("letters in order are found when no word is, and come last", () => {
  const all = [
    one("property", "wheel_radius"),
    one("link", "rear_wheel_rad"),
    one("file", "whrad.xacro"),
    one("link", "the wheel of another radius, far away"),
  ];
  assert.deepEqual(labels(all, "whrad"), ["whrad.xacro", "rear_wheel_rad", "wheel_radius"]);
  assert.deepEqual(labels(all, "xq"), []);
});

test("what begins with the word comes before what has it further on, and the shorter before the longer", () => {
  const all = [
    one("link", "rear_wheel"),
    one("property", "wheel_radius"),
    one("property", "wheels"),
  ];
  assert.deepEqual(labels(all, "wheel"), ["wheels", "wheel_radius", "rear_wheel"]);
});

test("the letters that were found are marked, each once", () => {
  assert.deepEqual(marksOf("wheel_radius", "rad wh"), [
    [0, 2],
    [6, 9],
  ]);
  assert.deepEqual(marksOf("wheel_radius", "whe wheel"), [[0, 5]]);
  assert.deepEqual(marksOf("wheel_radius", "whrad"), [
    [0, 2],
    [6, 9],
  ]);
  assert.deepEqual(marksOf("<b>&", "b"), [[1, 2]]);
  assert.deepEqual(marksOf("wheel", ""), []);
});
