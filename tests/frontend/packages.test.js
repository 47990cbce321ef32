import assert from "node:assert/strict";
import { test } from "node:test";
import { createLine } from "../../frontend_assets/app/package-dialogs.js";
import { argumentsOf, programChoices } from "../../frontend_assets/app/palette-programs.js";
import { connection, role } from "../../frontend_assets/model/connection.js";
import { workspaces } from "../../frontend_assets/model/programs.js";
import { dependencyDrawing } from "../../frontend_assets/panels/packages/package-graph.js";
import { isSought, problemsOf } from "../../frontend_assets/panels/packages/packages.js";
import { kindOfText } from "../../frontend_assets/panels/source/editor.js";

const talk = /** @type {any} */ ({
  name: "talk",
  folder: "/ws/talk",
  description: "Says a word",
  may_run: true,
  executables: [
    { name: "speaker", language: "python" },
    { name: "native", language: "c++" },
  ],
  interfaces: [{ name: "talk/srv/Say" }],
  launch_files: [{ file: "/ws/talk/launch/hall.launch.py" }],
});

test("a package is found by what it has", () => {
  for (const words of ["talk", "SPEAKER", "hall talk", "srv/say", ""])
    assert.ok(isSought(talk, words), words);
  assert.ok(!isSought(talk, "nothing"));
});

test("the problems of a package are those in its folder", () => {
  const at = (/** @type {string} */ file) => /** @type {any} */ ({ place: { file } });
  const all = [at("/ws/talk/setup.py"), at("/ws/talk_two/setup.py"), /** @type {any} */ ({})];
  assert.equal(problemsOf(all, talk).length, 1);
});

test("packages of the workspace are drawn, and unknown ones; those of ROS when they are asked for", () => {
  const graph = {
    nodes: [
      { name: "talk", presence: "workspace" },
      { name: "rclpy", presence: "ros" },
      { name: "rclpi", presence: "unknown" },
    ],
    edges: [
      { package: "talk", needs: "rclpy" },
      { package: "talk", needs: "rclpi" },
    ],
  };
  const all = /** @type {any} */ ([{ graph }]);
  assert.equal(dependencyDrawing(all, false).boxes.length, 2);
  assert.equal(dependencyDrawing(all, false).arrows.length, 1);
  assert.equal(dependencyDrawing(all, true).arrows.length, 2);
});

test("the line says what the window makes", () => {
  const form = {
    name: "talk",
    folder: "/ws",
    build_type: /** @type {const} */ ("ament_python"),
    contents: /** @type {const} */ ("nodes"),
    dependencies: "rclpy, std_msgs",
    node_name: "speaker",
    library_name: "",
    license: "MIT",
    description: "",
  };
  assert.equal(
    createLine(form),
    "ros2 pkg create talk --build-type ament_python --node-name speaker --license MIT --dependencies rclpy std_msgs",
  );
  assert.match(createLine({ ...form, contents: "interfaces" }), /--build-type ament_cmake/);
});

test("lines of ROS run and open the owner's own, where that is allowed", () => {
  role.value = "presenter";
  connection.value = "connected";
  workspaces.value = /** @type {any} */ ({
    run_folders: ["/ws"],
    workspaces: [{ packages: [talk], problems: [] }],
  });
  const labels = (/** @type {string} */ text) => programChoices(text).map(({ label }) => label);
  assert.deepEqual(labels("ros2 run talk spe"), ["ros2 run talk speaker"]);
  assert.deepEqual(labels("$ ros2 run talk speaker --ros-args -r a:=b"), [
    "ros2 run talk speaker --ros-args -r a:=b",
  ]);
  assert.deepEqual(labels("ros2 run talk native"), []);
  assert.deepEqual(labels("ros2 launch ta"), ["ros2 launch talk hall.launch.py"]);
  assert.deepEqual(labels("ros2 topic list"), []);
  role.value = "guest";
  assert.deepEqual(labels("ros2 run talk speaker"), []);
});

test("arguments of a launch file are read from a line", () => {
  assert.deepEqual(argumentsOf(["a:=1", "b:=x:=y", "c"]), { a: "1", b: "x:=y" });
});

test("texts are coloured by their endings", () => {
  const kinds = ["a.py", "a.YAML", "Say.srv", "CMakeLists.txt", "setup.cfg", "a.urdf.xacro"];
  assert.deepEqual(kinds.map(kindOfText), ["python", "yaml", "hashed", "hashed", "hashed", "xml"]);
});
