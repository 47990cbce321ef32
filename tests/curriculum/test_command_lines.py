"""Every line of `ros2` that the course prints, with `ros2` replaced, and what comes of it."""

from __future__ import annotations

import shlex
import signal
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import started, studio
from tests.support.demos import ENDS_WITHIN_S, running_demo
from tests.support.told_recording import ToldRecording, written
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

XACRO = (
    '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="bot${1 + 1}"><link name="a"/></robot>'
)


@dataclass(frozen=True)
class Ends:
    """A line that ends by itself: with this code, its words on stdout or stderr."""

    line: str
    said: str
    code: int = 0


@dataclass(frozen=True)
class GoesOn:
    """A line that goes on until Ctrl-C, then ends within two seconds."""

    line: str
    said: str


TWIST = '"{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"'
LINES = (
    Ends("--help", "commands:"),
    # Nodes
    Ends("node -h", "list"),
    Ends("node list", "/turtlesim\n"),
    Ends("node info /turtlesim", "  Action Servers:\n    /turtle1/rotate_absolute"),
    # Topics
    Ends("topic -h", "echo"),
    Ends("topic list", "/turtle1/cmd_vel\n"),
    Ends("topic info /chatter", "Type: std_msgs/msg/String\nPublisher count: 1\n"),
    Ends("topic info /topic_name", "Publisher count: 1\nSubscription count: 0\n"),
    Ends("topic type /topic_name", "std_msgs/msg/String\n"),
    GoesOn("topic echo /turtle1/cmd_vel geometry_msgs/msg/Twist", ""),
    GoesOn("topic echo /turtle1/pose", "linear_velocity: "),
    GoesOn("topic echo /topic_name std_msgs/msg/String", "data: Hello\n---\n"),
    GoesOn("topic pub /topic_name std_msgs/msg/String \"data: 'Hello'\"", "publishing #1: "),
    GoesOn(f"topic pub --rate 1 /turtle1/cmd_vel geometry_msgs/msg/Twist {TWIST}", "x=2.0"),
    # Services
    Ends("service list", "/add_two_ints\n"),
    Ends("service info /add_two_ints", "Type: example_interfaces/srv/AddTwoInts\n"),
    Ends("service type /add_two_ints", "example_interfaces/srv/AddTwoInts\n"),
    Ends(
        'service call /add_two_ints example_interfaces/srv/AddTwoInts "{a: 1, b: 2}"',
        "AddTwoInts_Response(sum=3)",
    ),
    Ends(
        "service call /spawn turtlesim/srv/Spawn \"{x: 2, y: 2, theta: 0.2, name: 'turtle2'}\"",
        "Spawn_Response(name='turtle2')",
    ),
    Ends('service call /spawn "{x: 2, y: 2}"', "cannot be used in ROS 2", 2),  # no type, as printed
    # Interfaces and parameters
    Ends("interface -h", "show"),
    Ends("interface show geometry_msgs/msg/Point", "float64 x\nfloat64 y\nfloat64 z\n"),
    Ends("interface show geometry_msgs/msg/Pose", "Point position\n\tfloat64 x\n"),
    Ends("interface show std_msgs/msg/String", "string data\n"),
    Ends("param list", "/turtlesim:\n  background_b\n  background_g\n  background_r\n"),
    # Packages
    Ends("pkg -h", "executables"),
    Ends("pkg list", "turtlesim\n"),
    Ends("pkg xml rover_description", "<name>rover_description</name>"),
    Ends("pkg executables turtlesim", "turtlesim turtlesim_node\n"),
    Ends("pkg create -h", "--node-name"),
    Ends("pkg create --build-type ament_cmake my_robot_description", "CMakeLists.txt\n"),
    Ends("pkg create --build-type ament_python my_python_package", "setup.py\n"),
    Ends(
        "pkg create urdf_view --build-type ament_python --dependencies rclpy --license Apache-2.0",
        "creating ./urdf_view/LICENSE\n",
    ),
    # Running
    GoesOn("run turtlesim turtlesim_node", "Spawning turtle"),
    GoesOn("run py_pkg_node print_forever_node", "print"),
    GoesOn("run radio_station service_server", ""),
    GoesOn("run radio_station radio_dj", ""),
    GoesOn("run rviz2 rviz2 --no-browser --router off --port 0", "http://127.0.0.1:"),
    Ends("run xacro xacro mybot.xacro", 'name="bot2"'),
    Ends("run turtlesim turtle_teleop_key", "Keys come from a terminal", 1),
    Ends(
        "run lifecycle lifecycle_service_client get_available_states --node-name n",
        "studio lifecycle get NODE",
        2,
    ),
    Ends("run my_robot_package my_robot_node", "has no executable", 2),
    # The rest
    Ends("doctor --report", "   NODE LIST\n"),
    Ends("doctor --report --include-dds", "doctor has no --include-dds", 2),
    Ends("daemon stop", "There is no daemon to stop"),
    Ends("daemon start", "No daemon is needed"),
    GoesOn("bag record /number -o bag1", "Recording..."),
    Ends("bag play ~/bags/bag1/", "[rosbag2_player]: Set rate to 1"),
    Ends("launch my_robot_description robot_display.launch.py", "No package", 2),
    Ends("launch urdf_view demo.launch.py", "No package", 2),
    # Misspelt as printed, and lines of the shell
    Ends(
        "service call_ /_spawn turtlesim_/srv/_Spawn_ '{x: 2}'",
        "did you mean: studio service call",
        2,
    ),
    Ends(
        "service call /get_now_playing radio_station_interfaces/srv/GetNowPlaying.srv",
        "write radio_station_interfaces/srv/GetNowPlaying",
        2,
    ),
    Ends("colcon build --packages-select radio_station", "nothing is built here", 2),
    Ends("source install/setup.bash", "needs no ROS", 2),
    Ends("rosdep install -i --from-path src --rosdistro humble -y", "package.xml", 2),
    Ends("rqt_graph", "Node graph", 2),
    Ends("rviz2", "studio open", 2),
)
ENDING = [one for one in LINES if isinstance(one, Ends)]
GOING_ON = [one for one in LINES if isinstance(one, GoesOn)]


@pytest.fixture(scope="module")
def endpoint() -> Generator[str]:
    """A world in which the lines mean something."""
    with (
        running_router() as found,
        running_demo(found, "turtlesim_node") as turtles,
        running_demo(found, "service_server_node"),
        started(found, "topic", "pub", "/topic_name", "std_msgs/msg/String", "data: Hello"),
        started(found, "topic", "pub", "/chatter", "std_msgs/msg/String", "data: Hello"),
    ):
        turtles.wait_for("Spawning turtle")
        wait_until("all", lambda: is_there(found))
        yield found


def is_there(endpoint: str) -> bool:
    at = ("--connect", endpoint)
    topics = studio("topic", "list", *at).out.split()
    return {"/chatter", "/topic_name"} <= set(topics) and (
        "/add_two_ints" in studio("service", "list", *at).out
    )


def is_serving_or_listening(line: str) -> bool:
    """Whether a line that prints nothing by itself is seen by others."""
    if line.startswith("topic echo"):
        return "Subscription count: 2" in studio("topic", "info", "/turtle1/cmd_vel").out
    node = {"service_server": "now_playing", "radio_dj": "action_server_node"}[
        line.rpartition(" ")[2]
    ]
    return node in studio("node", "list").out


@pytest.fixture(autouse=True)
def world(endpoint: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", f'connect/endpoints=["{endpoint}"]')
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mybot.xacro").write_text(XACRO)
    numbers = ToldRecording()
    numbers.add_topic("/number", "example_interfaces/msg/Int64")
    numbers.tell("/number", 0, data=7)
    (tmp_path / "bags").mkdir()
    written(numbers, tmp_path / "bags" / "bag1")


@pytest.mark.parametrize("row", ENDING, ids=lambda row: row.line)
def test_a_line_of_the_course_ends_as_expected(
    endpoint: str, row: Ends, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    if row.line.startswith("pkg create"):
        monkeypatch.chdir(tmp_path)
    if row.line.startswith("run "):  # a process of its own: it reads and changes its environment
        with started(endpoint, *shlex.split(row.line)) as process:
            assert process.wait() == row.code
            said = process.printed
    else:
        ran = studio(*shlex.split(row.line))
        assert ran.code == row.code, ran.err
        said = ran.out + ran.err
    assert row.said in said
    assert "Traceback" not in said


@pytest.mark.parametrize("row", GOING_ON, ids=lambda row: row.line)
def test_a_line_of_the_course_goes_on_until_ctrl_c(endpoint: str, row: GoesOn):
    with started(endpoint, *shlex.split(row.line)) as process:
        if row.said:
            process.wait_for(row.said)
        else:
            wait_until("it is there", lambda: is_serving_or_listening(row.line))
        process.process.send_signal(signal.SIGINT)
        process.wait(ENDS_WITHIN_S)
        assert "Traceback" not in process.printed


@pytest.mark.sweep  # it sings for twenty seconds, and goals are answered in quicker tests, too
def test_the_song_requester_of_the_course_is_answered(endpoint: str):
    with (
        started(endpoint, "run", "radio_station", "radio_dj"),
        started(endpoint, "run", "radio_station", "song_requester") as requester,
    ):
        requester.wait_for("Finished")
