/** @import { FrameView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { poseOfQuaternion, quaternionOf } from "../../frontend_assets/lib/frame-pose.js";
import {
  frameRows,
  framesBetween,
  isOwnWay,
  troubleOf,
  withLooseLinks,
} from "../../frontend_assets/lib/frame-tree.js";
import { shortTime } from "../../frontend_assets/lib/times.js";

/** @param {string} name @param {string} parent @param {Partial<FrameView>} [more] @returns {FrameView} */
const frame = (name, parent, more = {}) => ({
  name,
  parent,
  publisher: parent ? "/driver" : "",
  static: false,
  rate_hz: 30,
  age_s: 0.1,
  state: "fresh",
  ...more,
});

const ROBOT = [
  frame("base", "odom", { state: "stale" }),
  frame("lidar", "mast", { publisher: "this robot" }),
  frame("mast", "base", { publisher: "this robot" }),
  frame("moon", "", { state: "broken" }),
  frame("odom", ""),
  frame("rock", "moon", { state: "broken" }),
  frame("wheel", "base", { publisher: "this robot" }),
];

/** @param {readonly FrameView[]} frames @param {string} [filter] @param {string[]} [folded] */
const shown = (frames, filter = "", folded = []) =>
  frameRows(frames, "lidar", new Set(folded), filter).map(
    ({ frame: { name }, level }) => `${level} ${name}`,
  );

test("frames hang below their parents, and the tree of the fixed frame comes first", () => {
  assert.deepEqual(shown(ROBOT), [
    ...["1 odom", "2 base", "3 mast", "4 lidar", "3 wheel"],
    ...["1 moon", "2 rock"],
  ]);
});

test("a folded frame keeps its row, and a search opens it", () => {
  assert.deepEqual(shown(ROBOT, "", ["base", "moon"]), ["1 odom", "2 base", "1 moon"]);
  assert.deepEqual(shown(ROBOT, "LID", ["base"]), ["1 odom", "2 base", "3 mast", "4 lidar"]);
});

test("frames are found by who tells of them; every word has to be there", () => {
  assert.deepEqual(shown(ROBOT, "driver rock"), ["1 moon", "2 rock"]);
  assert.deepEqual(shown(ROBOT, "driver wheel"), []);
});

test("only what a search shows can be folded", () => {
  const rows = frameRows(ROBOT, "", new Set(), "odom");
  assert.deepEqual(
    rows.map(({ expandable }) => expandable),
    [false],
  );
});

test("what hangs below a stale frame says below which", () => {
  const behind = frameRows(ROBOT, "odom", new Set(), "").map((row) => row.behind);
  assert.deepEqual(behind, ["", "", "base", "base", "base", "", ""]);
});

test("a frame whose parent is left out of the list is a root, and nothing is lost", () => {
  assert.deepEqual(shown([frame("a", "gone"), frame("b", "a")]), ["1 a", "2 b"]);
});

test("a chain of ten thousand frames is walked", () => {
  const long = Array.from({ length: 10_000 }, (_, n) => frame(`f${n}`, n > 0 ? `f${n - 1}` : ""));
  assert.equal(frameRows(long, "f0", new Set(), "").length, 10_000);
  assert.equal(framesBetween(long, "f0", "f9999")?.length, 9_999);
});

test("the way goes up to the frame where both meet, and down", () => {
  assert.deepEqual(framesBetween(ROBOT, "lidar", "wheel"), [
    { at: "mast", up: true },
    { at: "base", up: true },
    { at: "wheel", up: false },
  ]);
  assert.deepEqual(framesBetween(ROBOT, "odom", "base"), [{ at: "base", up: false }]);
  assert.deepEqual(framesBetween(ROBOT, "base", "odom"), [{ at: "odom", up: true }]);
  assert.deepEqual(framesBetween(ROBOT, "base", "base"), []);
});

test("no way leads to another tree or to a frame that is not there", () => {
  assert.equal(framesBetween(ROBOT, "lidar", "rock"), null);
  assert.equal(framesBetween(ROBOT, "lidar", "nowhere"), null);
});

test("a way is the robot's own while nobody on the wire tells of a frame on it", () => {
  const own = (/** @type {string} */ from, /** @type {string} */ to) =>
    isOwnWay(ROBOT, from, framesBetween(ROBOT, from, to) ?? []);
  assert.equal(own("lidar", "wheel"), true);
  assert.equal(own("base", "lidar"), true);
  assert.equal(own("lidar", "odom"), false);
  assert.equal(own("odom", "base"), false);
});

test("a robot of one link has a frame, and one that hangs on nothing is broken", () => {
  const named = (/** @type {string[]} */ links, more = 0) =>
    withLooseLinks({ frames: [], fixed: "base", more }, links).map(
      ({ name, state }) => `${name} ${state}`,
    );
  assert.deepEqual(named(["base", "loose"]), ["base fresh", "loose broken"]);
  assert.deepEqual(named(["base"], 5), []);
  const told = { frames: ROBOT, fixed: "base", more: 0 };
  assert.equal(withLooseLinks(told, ["base", "wheel"]), ROBOT);
});

test("stale and broken frames are counted", () => {
  assert.deepEqual(troubleOf(ROBOT), { stale: 1, broken: 2 });
});

test("a pose of a quaternion has that quaternion again", () => {
  /** @type {[number, number, number, number]} */
  const wxyz = [0.5, -0.1, 0.7, Math.sqrt(1 - 0.25 - 0.01 - 0.49)];
  const pose = poseOfQuaternion(wxyz, [1, 2, 3]);
  const [x, y, z, w] = quaternionOf(pose);
  for (const [at, part] of [w, x, y, z].entries())
    assert.ok(Math.abs(part - (wxyz[at] ?? Number.NaN)) < 1e-12);
  assert.deepEqual([pose[3], pose[7], pose[11]], [1, 2, 3]);
});

test("a turn about z by a quarter takes x to y", () => {
  const pose = poseOfQuaternion([Math.SQRT1_2, 0, 0, Math.SQRT1_2], [0, 0, 0]);
  assert.ok(Math.abs((pose[4] ?? 0) - 1) < 1e-12);
});

test("spans of time are told in few letters", () => {
  assert.deepEqual([0.04, 9.94, 9.96, 59.4, 59.6, 3599, 7200].map(shortTime), [
    ...["0.0 s", "9.9 s", "10 s", "59 s", "1 min"],
    ...["1 h", "2 h"],
  ]);
});
