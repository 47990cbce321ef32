import assert from "node:assert/strict";
import { test } from "node:test";
import { inFrameOrder } from "../../frontend_assets/lib/frame-tree.js";

test("frames of the world come first, in the order of REP 105, then the base", () => {
  const found = inFrameOrder([
    "arm",
    "base_link",
    "odom",
    "base_footprint",
    "camera",
    "world",
    "map",
  ]);
  assert.deepEqual(found, ["map", "odom", "world", "base_footprint", "base_link", "arm", "camera"]);
});

test("other frames keep the order in which they were told", () => {
  assert.deepEqual(inFrameOrder(["wheel_2", "wheel_1", "odometer"]), [
    "wheel_2",
    "wheel_1",
    "odometer",
  ]);
});

test("frames of several robots are ordered by what follows their prefix", () => {
  assert.deepEqual(inFrameOrder(["a/base_link", "b/laser", "b/odom", "a/odom"]), [
    "b/odom",
    "a/odom",
    "a/base_link",
    "b/laser",
  ]);
});
