import assert from "node:assert/strict";
import { test } from "node:test";
import { ROS2_LINES, ros2LinesFor } from "../../frontend_assets/lib/ros2-lines.js";
import { PANEL_IDS } from "./support/panels.js";

/** @param {string} text @returns {string[]} */
const linesFor = (text) => ros2LinesFor(text).map(({ line }) => line.line);

test("a line that is being typed offers those that begin so", () => {
  assert.deepEqual(linesFor("ros2 service"), [
    ...["list", "type", "find", "info"].map((verb) => `ros2 service ${verb}`),
    "ros2 service call",
  ]);
  assert.deepEqual(linesFor("rvi"), ["rviz2"]);
  assert.deepEqual(linesFor("r"), []);
  assert.deepEqual(linesFor("wheel radius"), []);
});

test("a whole line is the one that fits it longest, with the words behind it", () => {
  const [echo] = ros2LinesFor("$ ros2 topic echo /chatter --once");
  assert.equal(echo?.line.panel, "topics");
  assert.deepEqual(echo?.rest, ["/chatter", "--once"]);
  assert.deepEqual(linesFor("ros2 run tf2_ros tf2_echo odom base"), ["ros2 run tf2_ros tf2_echo"]);
  const [call] = ros2LinesFor("studio service call /spawn turtlesim/srv/Spawn '{x: 2, y: 2}'");
  assert.equal(call?.line.form, "service");
  assert.deepEqual(call?.rest, ["/spawn", "turtlesim/srv/Spawn", "{x: 2, y: 2}"]);
});

test("each line leads to a panel, or to a command of the page", () => {
  for (const { line, panel } of ROS2_LINES)
    assert.ok(["arguments", "ros", ...PANEL_IDS].includes(panel), line);
});
