/** @import { JointView, LinkView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  linkOf,
  ofLink,
  ofPart,
  partWrittenAt,
  splitPartKey,
  stillThere,
} from "../../frontend_assets/model/selection.js";

/** @param {string} name @param {number} line @returns {LinkView} */
const link = (name, line) => ({
  ...{ name, visuals: 0, collisions: 0, mass_kg: null, meshes: [] },
  ...{ file: "/a.xacro", line, macros: [] },
});

/** @param {string} name @param {string} child @param {number} line @returns {JointView} */
const joint = (name, child, line) => ({
  ...{ name, type: "revolute", parent: "base", child, axis: [0, 0, 1] },
  ...{ lower: -1, upper: 1, mimic: "", multiplier: 1, file: "/a.xacro", line },
});

const ROBOT = {
  links: [link("base", 2), link("left_wheel", 10), link("right_wheel", 10), link("odd#2", 20)],
  joints: [joint("left_joint", "left_wheel", 14), joint("right_joint", "right_wheel", 14)],
};

test("a key is a kind and a name; the count of a repeated name is no part of it, but a sign in a name is", () => {
  assert.deepEqual(splitPartKey(ROBOT, "joint:left_joint"), ["joint", "left_joint"]);
  assert.deepEqual(splitPartKey(ROBOT, "link:base#2"), ["link", "base"]);
  assert.deepEqual(splitPartKey(ROBOT, "link:odd#2"), ["link", "odd#2"]);
});

test("a joint lights the link that it moves, and what has no link lights none of its own", () => {
  assert.equal(linkOf(ROBOT, "joint:left_joint"), "left_wheel");
  assert.equal(linkOf(ROBOT, "link:base"), "base");
  assert.equal(linkOf(ROBOT, "material:red"), null);
  assert.equal(linkOf(null, "joint:left_joint"), null);
});

test("a selected part remembers its element and who selected it", () => {
  const made = ofPart(null, ROBOT, { part: "joint:left_joint", element: "limit", by: "urdf" });
  assert.deepEqual(made, {
    ...{ part: "joint:left_joint", link: "left_wheel", element: "limit", attribute: "" },
    by: "urdf",
  });
});

test("a material is explained while the link that led to it stays lit", () => {
  const before = ofLink("base", "scene");
  assert.equal(ofPart(before, ROBOT, { part: "material:red" }).link, "base");
});

test("choosing a link anew forgets the joint, and no link is no selection", () => {
  assert.equal(ofLink("left_wheel", "scene")?.part, "link:left_wheel");
  assert.equal(ofLink(null), null);
});

test("a run that keeps all parts keeps the very selection", () => {
  const before = ofPart(null, ROBOT, { part: "joint:left_joint" });
  assert.equal(stillThere(before, ROBOT), before);
  const material = ofPart(ofLink("base"), ROBOT, { part: "material:red" });
  assert.equal(stillThere(material, ROBOT), material);
});

test("a link that is gone is not selected any more, and a joint that is gone leaves its link", () => {
  const smaller = { links: ROBOT.links.slice(0, 2), joints: [] };
  assert.equal(stillThere(ofLink("right_wheel"), smaller), null);
  const left = ofPart(null, ROBOT, { part: "joint:left_joint" });
  assert.equal(stillThere(left, smaller)?.part, "link:left_wheel");
  const right = ofPart(null, ROBOT, { part: "joint:right_joint" });
  assert.equal(stillThere(right, smaller), null);
});

test("a joint that moves another link now lights that one", () => {
  const before = ofPart(null, ROBOT, { part: "joint:left_joint" });
  const hung = { ...ROBOT, joints: [joint("left_joint", "base", 14)] };
  assert.equal(stillThere(before, hung)?.link, "base");
  assert.equal(stillThere(before, hung)?.part, "joint:left_joint");
});

test("a place of a macro is the part of the link that is lit, else the first that it made", () => {
  const at = { file: "/a.xacro", line: 10, kind: "link", name: "${side}_wheel" };
  assert.equal(partWrittenAt(ROBOT, at, null), "link:left_wheel");
  assert.equal(partWrittenAt(ROBOT, at, "right_wheel"), "link:right_wheel");
  assert.equal(partWrittenAt(ROBOT, at, "base"), "link:left_wheel");
  const joints = { ...at, line: 14, kind: "joint", name: "${side}_joint" };
  assert.equal(partWrittenAt(ROBOT, joints, "right_wheel"), "joint:right_joint");
});

test("a name that is written out is found also where lines were added above it", () => {
  const at = { file: "/a.xacro", line: 7, kind: "link", name: "base" };
  assert.equal(partWrittenAt(ROBOT, at, null), "link:base");
  assert.equal(partWrittenAt(ROBOT, { ...at, file: "/other.xacro" }, null), null);
  assert.equal(partWrittenAt(ROBOT, { ...at, name: "$(arg x)" }, null), null);
});
