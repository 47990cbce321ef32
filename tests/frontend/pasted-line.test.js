import assert from "node:assert/strict";
import { test } from "node:test";
import { readLine, shellWords } from "../../frontend_assets/lib/ros2-lines.js";

test("a service's call is taken apart", () => {
  const line = readLine(
    'ros2 service call /add_two_ints example_interfaces/srv/AddTwoInts "{a: 41, b: 1}"',
  );
  assert.equal(line?.kind, "service");
  assert.equal(line?.name, "/add_two_ints");
  assert.equal(line?.type, "example_interfaces/srv/AddTwoInts");
  assert.equal(line?.text, "{a: 41, b: 1}");
});

test("a publisher's rate, its short type and its lines that go on are taken", () => {
  const line = readLine(
    "$ ros2 topic pub --rate 2.5 /turtle1/cmd_vel geometry_msgs/Twist \\\n '{linear: {x: 2.0}}' --qos-durability transient_local --qos-depth=3",
  );
  assert.equal(line?.type, "geometry_msgs/msg/Twist");
  assert.equal(line?.rate_hz, 2.5);
  assert.equal(line?.text, "{linear: {x: 2.0}}");
  assert.deepEqual(line?.qos, { durability: "transient_local", depth: 3 });
});

test("once is once, and without a word it is once a second as ros2 does", () => {
  assert.equal(readLine("ros2 topic pub -1 /x std_msgs/msg/Empty")?.rate_hz, 0);
  assert.equal(readLine("ros2 topic pub --once /x std_msgs/msg/Empty {}")?.rate_hz, 0);
  assert.equal(readLine("ros2 topic pub /x std_msgs/msg/Empty")?.rate_hz, 1);
});

test("goals and parameters are known, too", () => {
  const goal = readLine("ros2 action send_goal --feedback /choose_song a/action/B '{song: x}'");
  assert.deepEqual([goal?.kind, goal?.name, goal?.text], ["action", "/choose_song", "{song: x}"]);
  const set = readLine("ros2 param set /turtlesim background_r 255");
  assert.deepEqual([set?.name, set?.type, set?.text], ["/turtlesim", "background_r", "255"]);
});

test("what is no such line is none", () => {
  for (const text of [
    "",
    "{a: 1}",
    "ros2 topic echo /x",
    "ros2 service call /x",
    "ls ros2",
    'ros2 service call /x a/srv/B "{',
  ])
    assert.equal(readLine(text), null, text);
});

test("words are read as a shell reads them", () => {
  assert.deepEqual(shellWords(`a 'b c'"d \\"e"  f\\ g ''`), ["a", 'b cd "e', "f g", ""]);
  assert.equal(shellWords("'open"), null);
});
