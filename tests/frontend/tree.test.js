import assert from "node:assert/strict";
import { test } from "node:test";
import { ancestorsOf, linkRows, linkTree, withoutInertia } from "../../frontend_assets/lib/tree.js";

/** @import { JointView, LinkView, RobotState } from "../../frontend_assets/types/wire.d.ts" */

/** @param {string} name @returns {LinkView} */
const link = (name) => ({
  name,
  visuals: 1,
  collisions: 0,
  mass_kg: 1,
  meshes: [],
  file: "",
  line: 0,
  macros: [],
});

/** @param {string} parent @param {string} child @returns {JointView} */
const joint = (parent, child) => ({
  name: `${parent}_${child}`,
  type: "fixed",
  parent,
  child,
  axis: [1, 0, 0],
  lower: null,
  upper: null,
  mimic: "",
  multiplier: 1,
  file: "",
  line: 0,
});

/** @param {string[]} links @param {[string, string][]} pairs @returns {RobotState} */
const robot = (links, pairs) => ({
  type: "robot",
  revision: 1,
  name: "r",
  root: "base",
  links: links.map(link),
  joints: pairs.map(([parent, child]) => joint(parent, child)),
});

const ROVER = robot(
  ["wheel", "base", "mast", "lidar", "loose"],
  [
    ["base", "wheel"],
    ["base", "mast"],
    ["mast", "lidar"],
  ],
);

/** @param {ReturnType<typeof linkRows>} rows */
const names = (rows) => rows.map(({ node, level }) => `${level} ${node.link.name}`);

test("links hang on their parents, the root comes first, a loose link is not lost", () => {
  assert.deepEqual(names(linkRows(linkTree(ROVER), new Set(), "")), [
    "1 base",
    "2 wheel",
    "2 mast",
    "3 lidar",
    "1 loose",
  ]);
});

test("a folded link hides what is below it", () => {
  assert.deepEqual(names(linkRows(linkTree(ROVER), new Set(["mast"]), "", 2)), [
    "2 base",
    "3 wheel",
    "3 mast",
    "2 loose",
  ]);
});

test("a filter keeps the way to what it finds, folded or not", () => {
  const rows = linkRows(linkTree(ROVER), new Set(["mast", "base"]), "LIDAR");
  assert.deepEqual(names(rows), ["1 base", "2 mast", "3 lidar"]);
});

test("joints that form a ring or name unknown links neither hang the page nor lose a link", () => {
  const ring = robot(
    ["base", "a", "b"],
    [
      ["a", "b"],
      ["b", "a"],
      ["nowhere", "base"],
    ],
  );
  const shown = linkRows(linkTree(ring), new Set(), "").map(({ node }) => node.link.name);
  assert.deepEqual(shown.toSorted(), ["a", "b", "base"]);
  assert.deepEqual(ancestorsOf(ring, "a"), ["b", "a"]);
});

test("the way up from a link ends at the root", () => {
  assert.deepEqual(ancestorsOf(ROVER, "lidar"), ["mast", "base"]);
});

test("a chain of ten thousand links is shown to its end, also what a filter finds there", () => {
  const links = Array.from({ length: 10_000 }, (_, n) => (n === 0 ? "base" : `l${n}`));
  const pairs = links.slice(1).map((name, n) => /** @type {[string, string]} */ ([links[n], name]));
  const roots = linkTree(robot(links, pairs));
  assert.equal(linkRows(roots, new Set(), "").at(-1)?.level, 10_000);
  assert.equal(linkRows(roots, new Set(), "l9999").length, 10_000);
  assert.deepEqual(linkRows(roots, new Set(), "nothing"), []);
});

test("a link lacks an inertia in the tree where it does in the list of problems, and nowhere else", () => {
  const problem = (/** @type {string} */ code, /** @type {string[]} */ parts) =>
    /** @type {any} */ ({ code, parts });
  const problems = [
    problem("missing-inertial", ["link:arm", "joint:shoulder"]),
    problem("root-inertial", ["link:base"]),
    problem("missing-inertial", ["link:left wheel", "joint:axle"]),
  ];
  assert.deepEqual([...withoutInertia(problems)], ["arm", "left wheel"]);
  assert.equal(withoutInertia(problems), withoutInertia(problems));
});
