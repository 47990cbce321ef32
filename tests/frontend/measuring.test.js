/** @import { Anchor } from "../../frontend_assets/model/viewport.js" */
/** @import { Pose } from "../../frontend_assets/lib/kinematics.js" */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { poseOf } from "../../frontend_assets/lib/kinematics.js";
import { allDigits } from "../../frontend_assets/lib/numbers.js";
import {
  anchorOfPart,
  angleBetween,
  angleText,
  lengthsText,
  lengthText,
  measured,
} from "../../frontend_assets/model/measuring.js";

const ROVER = JSON.parse(
  readFileSync(new URL("../support/link-poses.json", import.meta.url), "utf8"),
);

/** @param {string} name @param {string} child @param {string} [type] @param {number[]} [axis] */
const joint = (name, child, type = "revolute", axis = [0, 0, 1]) =>
  /** @type {any} */ ({ name, type, parent: "root", child, axis });

/** @type {(link: string, at: [number, number, number], normal?: [number, number, number] | null) => Anchor} */
const point = (link, at, normal = null) => ({ kind: "point", link, at, normal });
/** @type {(link: string) => Anchor} */
const frame = (link) => ({ kind: "frame", link });
/** @type {(link: string, name: string) => Anchor} */
const axis = (link, name) => ({ kind: "axis", link, joint: name });

/** @param {number | null | undefined} value @param {number} wanted @param {number} [within] */
const near = (value, wanted, within = 1e-12) =>
  assert.ok(Math.abs((value ?? Number.NaN) - wanted) <= within, `${value} is not ${wanted}`);

const POSES = new Map([
  ["root", poseOf([0, 0, 0, 0, 0, 0])],
  ["turned", poseOf([1, 0, 0, 0, 0, Math.PI / 2])],
  ["tipped", poseOf([0, 2, 0.5, Math.PI / 2, 0, 0])],
]);

test("frames of a real robot are as far apart as where yourdfpy puts them, to 1e-9", () => {
  const poses = /** @type {Map<string, Pose>} */ (new Map(Object.entries(ROVER.poses)));
  const [a, b] = [ROVER.poses.gripper, ROVER.poses.rear_left_wheel];
  const found = measured([frame("gripper"), frame("rear_left_wheel")], poses, ROVER.joints);
  near(found?.distance, Math.hypot(b[3] - a[3], b[7] - a[7], b[11] - a[11]), 1e-9);
  near(found?.inRoot[2], b[11] - a[11], 1e-9);
  // z axes are the third columns
  near(found?.angle, Math.acos(a[2] * b[2] + a[6] * b[6] + a[10] * b[10]), 1e-7);
});

test("a point moves with its link, and its way is told in the first link's frame", () => {
  const found = measured([point("turned", [1, 0, 0]), point("root", [1, 0, 0])], POSES, []);
  near(found?.distance, 1);
  assert.deepEqual(
    found?.inRoot.map((one) => Math.round(one * 1e12) / 1e12),
    [0, -1, 0],
  );
  near(found?.inFirst[0], -1);
  assert.equal(found?.toAxis, null);
  assert.equal(found?.angle, null);
});

test("normals of two surfaces make an angle", () => {
  const ends = [point("root", [0, 0, 0], [0, 0, 1]), point("tipped", [0, 0, 0], [0, 0, 1])];
  near(measured(ends, POSES, [])?.angle, Math.PI / 2);
});

test("two axes that pass each other are as near as their common normal is long", () => {
  const joints = [joint("one", "turned"), joint("other", "tipped")];
  const found = measured([axis("turned", "one"), axis("tipped", "other")], POSES, joints);
  near(found?.distance, Math.hypot(1, 2, 0.5));
  near(found?.toAxis, 1);
  near(found?.angle, Math.PI / 2);
});

test("parallel axes, and a point beside an axis, are as far as straight across", () => {
  const joints = [joint("one", "root"), joint("other", "turned")];
  near(measured([axis("root", "one"), axis("turned", "other")], POSES, joints)?.toAxis, 1);
  near(measured([axis("root", "one"), point("root", [3, 4, 9])], POSES, joints)?.toAxis, 5);
  near(measured([frame("tipped"), axis("root", "one")], POSES, joints)?.toAxis, 2);
});

test("of three points the angle at the middle one is told", () => {
  const ends = [point("root", [1, 0, 0]), point("root", [0, 0, 0]), point("root", [0, 2, 0])];
  near(measured(ends, POSES, [])?.corner, Math.PI / 2);
  near(measured(ends, POSES, [])?.distance, 1);
  const same = [point("root", [1, 0, 0]), point("root", [1, 0, 0]), point("root", [0, 2, 0])];
  assert.equal(measured(same, POSES, [])?.corner, null);
});

test("what the robot has no more cannot be measured", () => {
  assert.equal(measured([frame("root"), frame("gone")], POSES, []), null);
  assert.equal(measured([frame("root"), axis("turned", "gone")], POSES, []), null);
  const moved = [joint("one", "tipped")];
  assert.equal(measured([frame("root"), axis("turned", "one")], POSES, moved), null);
});

test("small angles keep their digits", () => {
  near(angleBetween([1, 0, 0], [1, 1e-9, 0]), 1e-9, 1e-20);
  near(angleBetween([1, 0, 0], [-2, 0, 0]), Math.PI);
  assert.equal(angleBetween([0, 0, 0], [1, 0, 0]), null);
});

test("a selected joint means its axis, a fixed one and a link their frame", () => {
  const joints = [joint("turn", "arm"), joint("hold", "tip", "fixed")];
  assert.deepEqual(anchorOfPart(joints, "joint:turn"), axis("arm", "turn"));
  assert.deepEqual(anchorOfPart(joints, "joint:hold"), frame("tip"));
  assert.deepEqual(anchorOfPart(joints, "link:a:b"), frame("a:b"));
  assert.equal(anchorOfPart(joints, "material:red"), null);
  assert.equal(anchorOfPart(joints, "joint:gone"), null);
});

test("numbers have their unit and a zero no sign", () => {
  const [si, usual] = [
    { millimetres: false, degrees: false },
    { millimetres: true, degrees: true },
  ];
  assert.equal(lengthText(-1e-10, si), "0 m");
  assert.equal(lengthText(0.1234567, usual), "123.457 mm");
  assert.equal(lengthsText([0.24080000000000001, -1 / 3], si), "0.2408  -0.333333 m");
  assert.equal(lengthText(0.1234567, usual, allDigits), "123.4567 mm");
  assert.equal(angleText(Math.PI / 3, usual), "60°");
  assert.equal(angleText(-1 / 3, si), "-0.333333 rad");
});
