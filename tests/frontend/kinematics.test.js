import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import {
  AT_REST,
  compose,
  inverse,
  motionOf,
  moved,
  poseOf,
  rootFromLinks,
} from "../../frontend_assets/lib/kinematics.js";

/** @import { Pose } from "../../frontend_assets/lib/kinematics.js" */

/** A robot as the studio tells it, and where yourdfpy puts its links; made by tests/support/link_poses.py. */
const ROVER = JSON.parse(
  readFileSync(new URL("../support/link-poses.json", import.meta.url), "utf8"),
);

/** @param {Pose} found @param {Pose} wanted @param {number} within @param {string} what */
function assertNear(found, wanted, within, what) {
  found.forEach((value, at) => {
    const off = Math.abs(value - (wanted[at] ?? Number.NaN));
    assert.ok(off <= within, `${what}: ${at} is off by ${off}`);
  });
}

test("every link of a real robot stands where yourdfpy puts it", () => {
  const poses = rootFromLinks(
    ROVER,
    (joint) => ROVER.origins[joint],
    (joint) => ROVER.positions[joint] ?? 0,
  );
  assert.equal(poses.size, Object.keys(ROVER.poses).length);
  assert.ok(poses.size > 15);
  for (const [link, pose] of poses) assertNear(pose, ROVER.poses[link], 1e-9, link);
});

test("the order in which links are listed does not matter", () => {
  const turned = { links: [...ROVER.links].reverse(), joints: [...ROVER.joints].reverse() };
  const origin = (/** @type {string} */ joint) => ROVER.origins[joint];
  const position = (/** @type {string} */ joint) => ROVER.positions[joint] ?? 0;
  const [one, other] = [
    rootFromLinks(ROVER, origin, position),
    rootFromLinks(turned, origin, position),
  ];
  for (const [link, pose] of one) assertNear(other.get(link) ?? [], pose, 0, link);
});

test("a pose and its inverse come to nothing", () => {
  const pose = poseOf([0.3, -2, 5, 0.4, -1.1, 2.9]);
  assertNear(compose(pose, inverse(pose)), AT_REST, 1e-15, "product");
  assertNear(moved(inverse(pose), moved(pose, [1, 2, 3])), [1, 2, 3], 1e-14, "point");
});

test("joints turn about their axis, slide along it, or stand still", () => {
  const quarter = motionOf({ type: "revolute", axis: [0, 0, 1] }, Math.PI / 2);
  assertNear(moved(quarter, [1, 0, 0]), [0, 1, 0], 1e-15, "turn");
  const slid = motionOf({ type: "prismatic", axis: [0, 0.6, 0.8] }, 0.5);
  assertNear(moved(slid, [1, 0, 0]), [1, 0.3, 0.4], 1e-15, "slide");
  assert.equal(motionOf({ type: "floating", axis: [1, 0, 0] }, 3), AT_REST);
});

test("links in a ring and joints without a frame end, too", () => {
  const joint = { type: /** @type {const} */ ("fixed"), axis: [1, 0, 0], lower: null, upper: null };
  const more = { mimic: "", file: "", line: 0 };
  const joints = [
    { ...joint, ...more, name: "a", parent: "one", child: "two" },
    { ...joint, ...more, name: "b", parent: "two", child: "one" },
  ];
  const robot = { links: [{ name: "one" }, { name: "two" }], joints: /** @type {any} */ (joints) };
  const poses = rootFromLinks(
    robot,
    () => undefined,
    () => 0,
  );
  assert.deepEqual([...poses.keys()].sort(), ["one", "two"]);
});
