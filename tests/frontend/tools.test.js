/** @import { ToolView } from "../../frontend_assets/types/wire.d.ts" */

import assert from "node:assert/strict";
import { test } from "node:test";
import { connection, hasControl } from "../../frontend_assets/model/connection.js";
import {
  isOneShot,
  mayTake,
  putToolAway,
  takeKind,
  takeTool,
  toolInHand,
  tools,
  toolValue,
} from "../../frontend_assets/model/tools.js";
import { progressOf } from "../../frontend_assets/panels/scene/navigation-goal.js";
import { targetKey } from "../../frontend_assets/panels/scene/tool-card.js";

/** @param {string} id @param {string} kind @param {Partial<ToolView>} [more] @returns {ToolView} */
const tool = (id, kind, more = {}) => ({
  ...{ id, kind, name: kind, icon: "pin", key: "X", publishes: "", values: {} },
  ...more,
});
const GOAL = tool("t2", "SetGoal", {
  publishes: "geometry_msgs/msg/PoseStamped",
  values: { Topic: "/goal_pose", "Send as": "Auto", Action: "/navigate_to_pose" },
});
const inHand = () => toolInHand.value?.id;
const ALL = [tool("t1", "Interact"), GOAL, tool("t3", "Measure"), { ...GOAL, id: "t4" }];

test("before the list is known nothing is in hand, then Interact", () => {
  tools.value = [];
  assert.equal(inHand(), undefined);
  tools.value = ALL;
  assert.equal(inHand(), "t1");
  takeTool("t3");
  assert.equal(inHand(), "t3");
  putToolAway();
  assert.equal(inHand(), "t1");
});

test("a tool that was removed leaves Interact in the hand", () => {
  tools.value = ALL;
  takeTool("t3");
  tools.value = ALL.filter(({ id }) => id !== "t3");
  assert.equal(inHand(), "t1");
});

test("what publishes is taken only with control, and falls out of the hand with it", () => {
  tools.value = ALL;
  putToolAway();
  connection.value = "connected";
  hasControl.value = false;
  takeKind("SetGoal");
  assert.equal(mayTake(GOAL), false);
  assert.equal(inHand(), "t1");
  hasControl.value = true;
  takeKind("SetGoal");
  assert.equal(inHand(), "t2");
  takeTool("t4");
  assert.equal(inHand(), "t4");
  hasControl.value = false;
  assert.equal(inHand(), "t1");
});

test("a tool is put away after one use unless it says otherwise", () => {
  assert.equal(isOneShot(GOAL), true);
  assert.equal(isOneShot(tool("t5", "PublishPoint", { values: { "Single click": false } })), false);
  assert.equal(toolValue(GOAL, "Topic"), "/goal_pose");
});

test("where a goal goes is said by how it is sent", () => {
  const as = (/** @type {string} */ one) =>
    targetKey({ ...GOAL, values: { ...GOAL.values, "Send as": one } });
  assert.deepEqual(["Auto", "Action", "Topic"].map(as), [
    "tool.to.either",
    "tool.to.action",
    "tool.to.topic",
  ]);
  assert.equal(targetKey(tool("t6", "PublishPoint")), "tool.to.topic");
});

test("how far a goal is stands in its newest feedback, as far as there is any", () => {
  const feedback = (/** @type {object} */ values) => [
    { number: 1, after_s: 0, values: JSON.stringify(values) },
  ];
  const parts = (/** @type {any} */ goal) => progressOf(goal).split(" · ");
  const whole = { distance_remaining: 1.5, navigation_time: { sec: 2, nanosec: 6e8 } };
  const told = { feedback: feedback({ ...whole, number_of_recoveries: 3 }) };
  assert.deepEqual(parts(told), [
    "navigation.distance",
    "navigation.time",
    "navigation.recoveries",
  ]);
  assert.deepEqual(parts({ feedback: feedback({ distance_remaining: 1 }) }), [
    "navigation.distance",
  ]);
  assert.equal(progressOf(/** @type {any} */ ({ feedback: [] })), "");
});
