import assert from "node:assert/strict";
import { test } from "node:test";
import { ranked } from "../../frontend_assets/lib/ranking.js";

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
