import assert from "node:assert/strict";
import { test } from "node:test";
import {
  CENTRE,
  drivable,
  drives,
  ofKeys,
  ofStick,
  speedOf,
  together,
} from "../../frontend_assets/model/driving.js";

const ROVER = { linear: 0.5, angular: 2, sideways: false };
const MECANUM = { ...ROVER, sideways: true };

test("a stick that is pushed up drives forward, one to the left turns to the left", () => {
  assert.deepEqual(speedOf(ofStick(0, -50, 50), ROVER), { x: 0.5, y: 0, yaw: 0 });
  assert.deepEqual(speedOf(ofStick(-50, 0, 50), ROVER), { x: 0, y: 0, yaw: 2 });
});

test("what can move sideways does so, and turns by other keys", () => {
  assert.deepEqual(speedOf(ofStick(-50, 0, 50), MECANUM), { x: 0, y: 0.5, yaw: 0 });
  assert.deepEqual(speedOf(ofKeys(["KeyQ"]), MECANUM), { x: 0, y: 0, yaw: 2 });
});

test("a stick is at rest around its middle, and goes no further than its rim", () => {
  assert.deepEqual(ofStick(2, -2, 50), CENTRE);
  assert.deepEqual(ofStick(0, 0, 0), CENTRE);
  const { x, y } = ofStick(3000, -4000, 50);
  assert.ok(Math.abs(Math.hypot(x, y) - 1) < 1e-9);
  assert.ok(x > 0 && y < 0);
});

test("just beyond its rest a stick drives slowly", () => {
  const { x } = ofStick(0, -5, 50);
  assert.ok(x > 0 && x < 0.05);
});

test("keys that are held add up, opposite ones to nothing", () => {
  assert.deepEqual(ofKeys(["ArrowUp", "KeyA"]), { x: 1, y: 1, turn: 0 });
  assert.deepEqual(ofKeys(["KeyW", "KeyS"]), CENTRE);
  assert.deepEqual(ofKeys(["KeyW", "ArrowUp"]), { x: 1, y: 0, turn: 0 });
  assert.ok(drives("KeyD") && !drives("KeyP") && !drives("constructor"));
});

test("two hands drive no faster than the limit", () => {
  const both = together([ofKeys(["KeyW", "KeyA", "KeyQ"]), { x: 1, y: 0.5, turn: 0 }]);
  assert.deepEqual(speedOf(both, ROVER), { x: 0.5, y: 0, yaw: 2 });
  assert.deepEqual(speedOf(together([]), ROVER), { x: 0, y: 0, yaw: 0 });
});

test("topics that take speeds are known by their type, those that somebody hears first", () => {
  const topic = (/** @type {string} */ name, /** @type {string} */ kind, subscribers = 0) => ({
    name,
    types: [`geometry_msgs/msg/${kind}`],
    subscribers,
  });
  const found = drivable([
    topic("/a/cmd_vel", "Twist"),
    topic("/z/cmd_vel", "TwistStamped", 2),
    topic("/pose", "Pose", 1),
  ]);
  assert.deepEqual(found, [
    { name: "/z/cmd_vel", stamped: true },
    { name: "/a/cmd_vel", stamped: false },
  ]);
});
