import assert from "node:assert/strict";
import { test } from "node:test";
import {
  asList,
  asOrigin,
  asText,
  matrixList,
  matrixOf,
  matrixText,
  quaternionOf,
  turnOf,
  wayBetween,
} from "../../frontend_assets/lib/frame-pose.js";
import { AT_REST, compose, inverse, poseOf } from "../../frontend_assets/lib/kinematics.js";

/** @import { JointView } from "../../frontend_assets/types/wire.d.ts" */
/** @import { Origin } from "../../frontend_assets/lib/kinematics.js" */

/** @param {number} seed @returns {() => number} from -1 to 1, the same ones every time */
function random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
    return state / 2 ** 31 - 1;
  };
}

/** @param {readonly number[]} one @param {readonly number[]} other @param {number} [within] */
function near(one, other, within = 1e-12) {
  assert.equal(one.length, other.length);
  one.forEach((value, at) => {
    assert.ok(Math.abs(value - (other[at] ?? Number.NaN)) <= within, `${one} is not ${other}`);
  });
}

/** @returns {Origin[]} */
function origins() {
  const next = random(7);
  return Array.from({ length: 200 }, () => {
    const turn = () => next() * Math.PI;
    return /** @type {Origin} */ ([next(), next(), next(), turn(), turn() / 2.0001, turn()]);
  });
}

/** @param {string} parent @param {string} child @returns {JointView} */
const joint = (parent, child) => ({
  ...{ name: `${parent}_${child}`, type: "fixed", parent, child, axis: [1, 0, 0] },
  ...{ lower: null, upper: null, mimic: "", multiplier: 1, file: "", line: 0 },
});

const TREE = [joint("base", "arm"), joint("arm", "hand"), joint("base", "mast")];

test("roll, pitch and yaw that made a pose are read back from it", () => {
  for (const origin of origins()) near(turnOf(poseOf(origin)).rpy, origin.slice(3), 1e-9);
});

test("at a pitch of 90 degrees roll is told as zero, which gives the same pose, and it is said", () => {
  for (const pitch of [Math.PI / 2, -Math.PI / 2]) {
    const pose = poseOf([0, 0, 0, 0.4, pitch, 1.1]);
    const { rpy, locked } = turnOf(pose);
    assert.equal(locked, true);
    assert.equal(rpy[0], 0);
    near(poseOf([0, 0, 0, ...rpy]), pose);
  }
  assert.equal(turnOf(poseOf([0, 0, 0, 0, 1.5, 0])).locked, false);
});

test("a quaternion has length 1, no negative w, and turns as its pose does", () => {
  for (const origin of origins()) {
    const pose = poseOf(origin);
    const [x, y, z, w] = quaternionOf(pose);
    near([Math.hypot(x, y, z, w)], [1]);
    assert.ok(w >= 0);
    const turned = [
      ...[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
      ...[2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
      ...[2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ];
    near(
      turned,
      [0, 1, 2].flatMap((row) => pose.slice(4 * row, 4 * row + 3)),
    );
  }
});

test("half a turn about each axis has its quaternion", () => {
  near(quaternionOf(poseOf([0, 0, 0, Math.PI, 0, 0])), [1, 0, 0, 0]);
  near(quaternionOf(poseOf([0, 0, 0, 0, 0, Math.PI])), [0, 0, 1, 0]);
  near(quaternionOf(AT_REST), [0, 0, 0, 1]);
});

test("what is copied is exact, without the noise of the arithmetic", () => {
  const pose = compose(inverse(poseOf([1, 2, 3, 0.1, 0.2, 0.3])), poseOf([1, 2, 3, 0.1, 0.2, 0.3]));
  assert.equal(asOrigin(pose), '<origin xyz="0 0 0" rpy="0 0 0"/>');
  assert.equal(asText([0.1, -2, 1e-17]), "0.1 -2 0");
  assert.equal(asList([0.1, -2, 1 / 3]), "[0.1, -2, 0.333333333333]");
  assert.equal(matrixText(AT_REST), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1");
  assert.equal(matrixList(AT_REST), "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]");
  assert.deepEqual(matrixOf(poseOf([1, 2, 3, 0, 0, 0])).at(2), [-0, 0, 1, 3]);
});

test("the way leads up to what both have above them, and down again", () => {
  const names = wayBetween(TREE, "hand", "mast")?.map(({ joint: one, up }) => [one.name, up]);
  assert.deepEqual(names, [
    ["arm_hand", true],
    ["base_arm", true],
    ["base_mast", false],
  ]);
  assert.deepEqual(wayBetween(TREE, "hand", "hand"), []);
});

test("between two roots there is no way, and a ring of joints ends the search", () => {
  assert.equal(wayBetween(TREE, "hand", "elsewhere"), null);
  const ring = [joint("a", "b"), joint("b", "a")];
  assert.equal(wayBetween(ring, "a", "other"), null);
});
