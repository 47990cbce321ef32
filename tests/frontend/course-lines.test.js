import assert from "node:assert/strict";
import { test } from "node:test";
import {
  commandsOf,
  distance,
  mendedLine,
  oneLine,
  toldLines,
} from "../../frontend_assets/lib/course-lines.js";
import { readLine, ros2LinesFor } from "../../frontend_assets/lib/ros2-lines.js";
import { PANEL_IDS } from "./support/panels.js";
import { wordsOf } from "./support/words.js";

const APT = "software-properties-common curl terminator git";
const TWIST = '"{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"';

/** Lines that courses print, and the panel where each is done. @type {readonly [string, string][]} */
const DONE = [
  ["ros2 node list", "graph"],
  ["ros2 node info <node_name>", "graph"],
  ["# ros2 node info /turtlesim", "graph"],
  ["ros2 topic list", "topics"],
  ["ros2 topic info /chatter", "topics"],
  ["# ros2 topic echo /turtle1/cmd_vel", "topics"],
  ["ros2 topic echo /topic_name std_msgs/msg/String", "topics"],
  ["ros2 topic type /topic_name", "topics"],
  ["ros2 topic pub /topic_name std_msgs/msg/String \"data: 'Hello'\"", "publish"],
  [`# ros2 topic pub --rate 1 /turtle1/cmd_vel geometry_msgs/msg/Twist ${TWIST}`, "publish"],
  ["ros2 service list", "services"],
  ["ros2 service info /service_name", "services"],
  ["ros2 service type /service_name", "services"],
  ['ros2 service call /add_two_ints example_interfaces/srv/AddTwoInts "{a: 1, b: 2}"', "services"],
  ["ros2 service call <service_name> <service_data_type>", "services"],
  ["ros2 interface show geometry_msgs/msg/Point", "interfaces"],
  ["ros2 param list", "parameters"],
  ["ros2 run rviz2 rviz2", "scene"],
  ["rviz2", "scene"],
  ["rviz2 -d urdf_view/urdf.rviz", "scene"],
  ["rqt_graph", "graph"],
  ["ros2 run turtlesim turtlesim_node ", "turtlesim"],
  ["ros2 run turtlesim turtle_teleop_key ", "teleop"],
  ["ros2 run py_pkg_node print_forever_node", "lessons"],
  ["ros2 run radio_station service_server", "lessons"],
  ["ros2 run radio_station radio_dj", "lessons"],
  ["ros2 run radio_station song_requester", "lessons"],
  ["ros2 run my_robot_package my_robot_node", "lessons"],
  ["ros2 doctor --report", "doctor"],
  ["ros2 doctor --report --include-dds", "doctor"],
  ["ros2 launch my_robot_description robot_display.launch.py", "launch"],
  ["ros2 launch my_package my_launch_file.py", "launch"],
  ["ros2 launch urdf_view demo.launch.py", "launch"],
  ["ros2 bag record /number -o bag1", "bag"],
  ["ros2 bag record <topic_name> -o <save_path>", "bag"],
  ["ros2 bag play ~/bags/bag1/", "bag"],
  [" ros2 bag play <rosbag_filename>", "bag"],
  ["ros2 bag info bag1", "bag"],
];

/** And those that are told about. @type {readonly [string, string][]} */
const TOLD = [
  ["mkdir -p ~/ros2_ws/src", "folders"],
  ["cd ~/ros2_ws/src", "folders"],
  ["nano urdf/my_robot.xacro  # paste your robot model", "file"],
  ["touch launch/robot_display.launch.py", "file"],
  ["source /opt/ros/humble/setup.bash", "source_ros"],
  ["source /opt/ros/<distro>/setup.bash", "source_ros"],
  ["source install/setup.bash", "source_workspace"],
  ["source install/local_setup.sh", "source_workspace"],
  ["source ~/ros2_ws/install/setup.bash", "source_workspace"],
  [". install/setup.bash", "source_workspace"],
  ["source ~/.bashrc", "alias"],
  ["source ~/<env name>/bin/activate", "venv"],
  ["conda create -n <env_name> python=<py_version>", "venv"],
  ["conda activate <env_name>", "venv"],
  ["python3 -m venv <env_name>", "venv"],
  ['alias ros_2="source ~/<env_name>/bin/activate"', "alias"],
  ["export ROS_APT_SOURCE_VERSION=$(curl -s https://example.org | grep -F x)", "alias"],
  ["sudo apt update", "install"],
  [`sudo apt install -y ${APT}`, "install"],
  ["sudo add-apt-repository universe", "install"],
  ["sudo dpkg -i /tmp/ros2-apt-source.deb", "install"],
  ["curl -L -o /tmp/ros2-apt-source.deb https://example.org", "install"],
  ["git clone https://example.org/ros_tutorials.git -b humble", "git_clone"],
  ["rosdep install -i --from-path src --rosdistro humble -y", "rosdep"],
  ["colcon build", "colcon_build"],
  ["colcon build --packages-select radio_station_interfaces", "colcon_select"],
  ["colcon build --symlink-install --packages-select urdf_view", "colcon_symlink"],
  ["colcon test", "colcon_test"],
  ["ros2 daemon stop", "daemon"],
  ["ros2 bag convert -i bag1 -o out.yaml", "bag"],
  ["ros2 pkg create --build-type ament_python my_python_package", "pkg_create"],
  ["ros2 pkg create -h", "pkg_create"],
  ["ros2 pkg -h", "pkg"],
  ["ros2 pkg list", "pkg"],
  ["ros2 pkg xml <package_name>", "pkg"],
  ["ros2 pkg executables <package_name>", "pkg"],
  ["ros2 pkg prefix turtlesim", "pkg"],
  ["ros2 run xacro xacro mybot.xacro > mybot.urdf", "xacro"],
  ["gz sim", "gazebo"],
];

for (const [line, panel] of DONE)
  test(`this line of a course is done here: ${line}`, () => {
    assert.deepEqual(
      commandsOf(line).flatMap((one) => ros2LinesFor(one).map((found) => found.line.panel)),
      [panel],
    );
    assert.deepEqual(toldLines(line), []);
  });

test("the panels that lines are told with are there", () => {
  for (const [line] of TOLD)
    for (const { panel } of toldLines(line)) assert.ok(!panel || PANEL_IDS.includes(panel), panel);
});

for (const [line, key] of TOLD)
  test(`this line of a course is explained: ${line}`, () => {
    const [told, ...more] = toldLines(line);
    assert.equal(told?.key, key);
    assert.deepEqual(more, []);
    for (const language of ["en", "de"]) assert.ok(wordsOf(language)[`line.${key}`], language);
  });

test("help of ros2 offers the lines that begin so", () => {
  const offered = (/** @type {string} */ text) => ros2LinesFor(text).map(({ line }) => line.line);
  assert.ok(offered("ros2 --help").length > 20);
  assert.deepEqual(offered("ros2 node -h"), ["ros2 node list", "ros2 node info"]);
  assert.ok(offered("ros2 topic -h").includes("ros2 topic echo"));
  assert.ok(offered("ros2 interface -h").includes("ros2 interface show"));
});

/** Misspelt, as printed or as people type; and what was meant. @type {readonly [string, string][]} */
const MISSPELT = [
  [
    "# ros2 service call_ /_spawn turtlesim_/srv/_Spawn_ \"{x: 2, y: 2, theta: 0.2, name: 'turtle2'}\"",
    "ros2 service call /spawn turtlesim/srv/Spawn \"{x: 2, y: 2, theta: 0.2, name: 'turtle2'}\"",
  ],
  [
    "ros2 service call /get_now_playing radio_station_interfaces/srv/GetNowPlaying.srv",
    "ros2 service call /get_now_playing radio_station_interfaces/srv/GetNowPlaying",
  ],
  [
    "ros2 service call /spawn '{x: 2, y: 2}'",
    'ros2 service call /spawn turtlesim/srv/Spawn "{x: 2, y: 2}"',
  ],
  ["ros2 service call spawn", "ros2 service call spawn turtlesim/srv/Spawn"],
  ["ros2 topic ehco /chatter", "ros2 topic echo /chatter"],
  ["ros2 tpoic list", "ros2 topic list"],
  [
    "ros2 topic echo /chatter std_msgs/msg/String.msg",
    "ros2 topic echo /chatter std_msgs/msg/String",
  ],
  ["studio nodes list", "ros2 node list"],
  ["ros2 doctor --report --include-dds", "ros2 doctor --report"],
  [
    "ros2 run lifecycle lifecycle_service_client get_available_states --node-name talker",
    "ros2 lifecycle get talker",
  ],
];

for (const [line, meant] of MISSPELT)
  test(`what was meant is found: ${line}`, () => {
    const typeOf = (/** @type {string} */ kind, /** @type {string} */ name) =>
      kind === "service" && name === "/spawn" ? "turtlesim/srv/Spawn" : "";
    assert.equal(mendedLine(line, typeOf), meant);
    assert.equal(mendedLine(meant, typeOf), null);
  });

test("a mended call fills the form", () => {
  const line = "ros2 service call_ /_spawn turtlesim_/srv/_Spawn_ '{x: 2}'";
  const read = readLine(mendedLine(line) ?? "");
  assert.deepEqual(
    [read?.name, read?.type, read?.text],
    ["/spawn", "turtlesim/srv/Spawn", "{x: 2}"],
  );
});

test("lines that are right, or none of ros2, are left as they are", () => {
  for (const [line] of DONE.filter(([one]) => !one.includes("--include-dds")))
    assert.equal(mendedLine(line), null, line);
  for (const line of ["", "ros2", "wheel", "ros2 topic echo /_hidden", "ros2 xyz", "ls 'a"])
    assert.equal(mendedLine(line), null, line);
});

test("several lines of a terminal are taken one by one", () => {
  const pasted = "cd ~/ros2_ws && colcon build\nsource install/setup.bash\n$ ros2 topic list";
  assert.equal(
    oneLine("ros2 pkg create x \\\n  --build-type ament_python"),
    "ros2 pkg create x --build-type ament_python",
  );
  assert.equal(
    oneLine("ros2 pkg create x --build-type ament_python\n--dependencies rclpy"),
    "ros2 pkg create x --build-type ament_python --dependencies rclpy",
  );
  assert.deepEqual(commandsOf(pasted), [
    "cd ~/ros2_ws",
    "colcon build",
    "source install/setup.bash",
    "ros2 topic list",
  ]);
  assert.deepEqual(
    toldLines(pasted).map(({ key }) => key),
    ["folders", "colcon_build", "source_workspace"],
  );
  assert.deepEqual(toldLines("ros2 daemon stop && ros2 daemon start").length, 1);
});

test("words are as far apart as the letters that differ", () => {
  assert.equal(distance("echo", "ehco"), 1);
  assert.equal(distance("call_", "call"), 1);
  assert.equal(distance("", "abc"), 3);
});
