import assert from "node:assert/strict";
import { test } from "node:test";
import {
  byPackage,
  definesType,
  faultPlace,
  fieldType,
  foundNames,
  kindOf,
  nameParts,
  typesAmong,
  valueText,
} from "../../frontend_assets/model/interfaces.js";

/** @param {string[]} paths */
const files = (...paths) => paths.map((path) => ({ path, file: path }));

test("dropped files of a package are named by its manifest, else by its folder", () => {
  const dropped = files("ws/arm/package.xml", "ws/arm/msg/Pose.msg", "ws/arm/srv/Go.srv");
  assert.deepEqual(
    typesAmong(dropped)?.named.map(({ name }) => name),
    ["arm/msg/Pose", "arm/srv/Go"],
  );
  const manifests = new Map([["ws/arm", "arm_interfaces"]]);
  assert.deepEqual(
    typesAmong(dropped, manifests)?.named.map(({ name }) => name),
    ["arm_interfaces/msg/Pose", "arm_interfaces/srv/Go"],
  );
});

test("a file that does not tell its package is loose, and a robot is no type", () => {
  assert.deepEqual(typesAmong(files("Pose.msg")), {
    named: [],
    loose: [{ type: "Pose", kind: "msg", file: "Pose.msg" }],
  });
  assert.equal(typesAmong(files("arm/msg/Pose.msg", "arm/urdf/arm.urdf.xacro")), null);
  assert.equal(typesAmong(files("readme.md", "mesh.stl")), null);
  assert.equal(typesAmong([]), null);
});

test("what a text defines is told by its lines of dashes", () => {
  assert.equal(kindOf("int32 x\n"), "msg");
  assert.equal(kindOf("int32 x\n---\nint32 y"), "srv");
  assert.equal(kindOf("---\n---\n"), "action");
});

test("a pasted text defines a type where each of its lines does", () => {
  for (const text of [
    "# How it is.\nstring robot_name\nfloat32 battery_percent # of all\n",
    "int64 a\nint64 b\n---\nint64 sum\n",
    "uint8 OK=0\nstring<=10[<=3] names\ngeometry_msgs/Pose[] poses\nfloat64 x 1.5",
    "std_msgs/msg/Header header\nTemperature warm",
  ])
    assert.ok(definesType(text), text);
  for (const text of [
    "",
    "hello world",
    "The robot moves",
    "<robot name='x'/>",
    "ros2 topic pub /cmd_vel geometry_msgs/msg/Twist",
    "int32 x\nand some more, in words.",
  ])
    assert.ok(!definesType(text), text);
});

test("a full name has three parts, each as ROS wants it", () => {
  assert.deepEqual(nameParts("my_robot/msg/Telemetry"), {
    package: "my_robot",
    kind: "msg",
    type: "Telemetry",
  });
  for (const bad of ["", "msg/X", "My/msg/X", "my/msg/x", "my/idl/X", "my/msg/X/Y"])
    assert.equal(nameParts(bad), null);
});

test("a search wants every word, and types named so come first", () => {
  const names = ["geometry_msgs/msg/Pose", "nav_msgs/msg/Posture", "pose_msgs/msg/Other"];
  assert.deepEqual(foundNames(names, "pose"), [names[0], names[2]]);
  assert.deepEqual(foundNames(names, "MSGS post"), [names[1]]);
  assert.deepEqual([...byPackage(names).keys()], ["geometry_msgs", "nav_msgs", "pose_msgs"]);
});

test("a field is written as in its text", () => {
  const field = { name: "x", default: null, comment: "", count: 0, string_bound: 0 };
  /** @param {Partial<import("../../frontend_assets/types/wire.d.ts").FieldView>} news */
  const words = (news) => fieldType({ ...field, base: "float64", shape: "single", ...news });
  assert.equal(words({}), "float64");
  assert.equal(words({ shape: "array", count: 36 }), "float64[36]");
  assert.equal(words({ shape: "bounded", count: 3 }), "float64[<=3]");
  assert.equal(
    words({ shape: "sequence", base: "geometry_msgs/msg/Pose" }),
    "geometry_msgs/Pose[]",
  );
  assert.equal(words({ base: "string", string_bound: 5 }), "string<=5");
  assert.equal(valueText([1, 2]), "[1, 2]");
  assert.equal(valueText("a"), '"a"');
  assert.equal(valueText(null), "");
});

test("the place of a fault is its file below the folders above the package, with the line", () => {
  const place = "/ws/src/own_interfaces/msg/Bad.msg";
  assert.equal(faultPlace({ place, line: 2 }), "own_interfaces/msg/Bad.msg:2");
  assert.equal(faultPlace({ place: "own_interfaces/srv/Ask", line: 0 }), "own_interfaces/srv/Ask");
});
