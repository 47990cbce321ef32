from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import comes_to, started, studio
from tests.support.student_programs import SETUP_CFG, python_package, studio_run
from tests.support.wire import free_endpoint, wait_until

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_node_brings_the_router_and_ends_within_two_seconds(number: int):
    endpoint = free_endpoint()
    words = ("run", "demo_nodes_py", "talker", "--connect", endpoint)
    with started(endpoint, *words) as talker:
        talker.wait_for("Publishing: ")
        wait_until(
            "the topic", lambda: "/chatter" in studio("topic", "list", "--connect", endpoint).out
        )
        talker.stop(number)  # which waits for two seconds
        assert "Traceback" not in talker.printed


def test_without_a_router_and_without_leave_to_start_one_a_sentence_is_said():
    endpoint = free_endpoint()
    ran = studio("run", "demo_nodes_py", "talker", "--connect", endpoint, "--router", "off")
    assert ran.code == 2
    assert "No Zenoh router answers" in ran.err


@pytest.mark.parametrize("line", ["up.launch.py", "up.launch.xml", "my_pkg up.launch.py"])
def test_a_launch_file_is_answered_with_its_command(line: str):
    ran = studio("run", *line.split())
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.endswith(f": this is a launch file: studio launch {line}\n")


def test_n8_a_remap_moves_the_topic(endpoint: str):
    at = ("--connect", endpoint)
    words = ("run", "demo_nodes_py", "talker", *at, "--ros-args", "-r", "chatter:=/x", "-r",
             "__node:=other")  # fmt: skip
    with started(endpoint, *words) as talker:
        talker.wait_for("[other]: Publishing: ")
        comes_to(lambda ran: "/x" in ran.out.split(), "topic", "list", *at)
        assert "/chatter" not in studio("topic", "list", *at).out.split()


def test_executables_of_the_course_are_listed():
    listed = studio("pkg", "executables").out.splitlines()
    for line in (
        "turtlesim turtlesim_node",
        "radio_station service_server",
        "radio_station radio_dj",
        "radio_station song_requester",
        "py_pkg_node print_forever_node",
    ):
        assert line in listed


def test_what_cannot_be_started_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    package = tmp_path / "src" / "own_pkg"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>own_pkg</name></package>")
    (package / "setup.py").write_text(
        "setup(entry_points={'console_scripts': ['mine = own_pkg.mine:main']})"
    )
    monkeypatch.chdir(tmp_path)
    for words, said in (
        (("no_such", "x"), 'No package "no_such"'),
        (("turtlesim", "x"), "it has turtle_teleop_key, turtlesim_node"),
        (
            ("own_pkg", "mine"),
            f'{package}/setup.py:1: "mine" starts own_pkg.mine, and no file of the package is',
        ),
        (("own_pkg", "other"), 'has no executable "other": it has mine; a new one is a line of'),
        (("rover_description", "x"), "starts nothing"),
        (("--demo", "own_pkg", "mine"), "The studio has no node own_pkg mine"),
    ):
        ran = studio("run", *words)
        assert ran.code == 2
        assert said in ran.err
        assert ran.err.count("\n") == 1


@pytest.mark.parametrize(
    ("given", "unused"),
    [
        (["-p", "use_sim_time:=true"], ""),
        (["-p", "use_sim_time:=false"], "-p use_sim_time:=false"),
        (
            [
                *("-r", "__ns:=/a", "-r", "rviz:scan:=/b", "-p", "use_sim_time:=True"),
                *("-p", "x:=1", "--params-file", "p.yaml", "--log-level", "debug"),
            ],
            "-r __ns:=/a, -r rviz:scan:=/b, -p x:=1, --params-file p.yaml, --log-level debug",
        ),
    ],
)
def test_what_rviz_would_take_of_ros_arguments_and_the_studio_does_not_is_named(
    tmp_path: Path, given: list[str], unused: str
):
    view = str(tmp_path / "none.rviz")
    ran = studio("run", "rviz2", "rviz2", "--ros-args", *given, "--", "-d", view)
    *before, last = ran.err.splitlines()
    assert "No such file" in last
    said = f"WARNING: studio open, which runs in place of rviz2, does not use {unused}."
    assert before == ([said] if unused else [])


def test_an_argument_that_is_none_of_ross_ends_rviz_with_a_sentence():
    ran = studio("run", "rviz2", "rviz2", "--ros-args", "-d", "view.rviz")
    assert (ran.code, ran.out) == (2, "")
    assert "-d" in ran.err


def test_xacro_is_a_command_of_the_studio(tmp_path: Path):
    robot = tmp_path / "r.xacro"
    robot.write_text('<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="${1 + 1}"/>')
    with started("tcp/127.0.0.1:1", "run", "xacro", "xacro", str(robot)) as expanded:
        assert expanded.wait() == 0
    assert 'name="2"' in expanded.printed


SERVER = "def main():\n    print('mine')\n"
CMAKE = """\
project(demo_nodes_py)
add_executable(talker src/talker.cpp)  # add_executable(none src/none.cpp)
install(TARGETS talker DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/listener.py
  DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
"""


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace as colcon builds it, with two packages that are called as demos of ours are."""
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    python = tmp_path / "ws" / "src" / "learning_interface"
    (python / "learning_interface").mkdir(parents=True)
    (python / "package.xml").write_text("<package><name>learning_interface</name></package>")
    (python / "setup.py").write_text(
        "setup(entry_points={'console_scripts': ['server = learning_interface.own_server:main']})"
    )
    (python / "setup.cfg").write_text(SETUP_CFG.format(name="learning_interface"))
    (python / "learning_interface" / "own_server.py").write_text(SERVER)
    cmake = tmp_path / "ws" / "src" / "demo_nodes_py"
    (cmake / "src").mkdir(parents=True)
    (cmake / "src" / "talker.cpp").write_text("int main() {}\n")
    (cmake / "package.xml").write_text("<package><name>demo_nodes_py</name></package>")
    (cmake / "CMakeLists.txt").write_text(CMAKE)
    return tmp_path / "ws"


@pytest.mark.parametrize("inside", [True, False])
def test_a_node_of_the_workspace_runs_before_the_demo_of_its_name(
    workspace: Path, inside: bool, endpoint: str
):
    named = [] if inside else ["--package-path", str(workspace / "src")]
    cwd = workspace if inside else workspace.parent
    ran = studio_run(endpoint, "learning_interface", "server", *named, cwd=cwd)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "mine\n", "")


def test_programs_of_a_cmake_package_come_before_the_demo_too(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(workspace / "src")
    ran = studio("run", "demo_nodes_py", "talker")
    assert ran.code == 2
    assert f"compiled from {workspace / 'src/demo_nodes_py/src/talker.cpp'}" in ran.err
    assert "colcon build --packages-select demo_nodes_py" in ran.err
    listed = studio("pkg", "executables", "demo_nodes_py").out
    assert listed == "demo_nodes_py listener.py\ndemo_nodes_py talker\n"
    ran = studio("run", "demo_nodes_py", "listener")
    assert 'has no executable "listener": it has listener.py, talker.' in ran.err
    assert "studio run --demo demo_nodes_py listener" in ran.err


def test_the_demo_runs_where_it_is_asked_for_by_its_option(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(workspace)
    with started(free_endpoint(), "run", "--demo", "demo_nodes_py", "talker") as talker:
        talker.wait_for("Publishing: ")


def test_an_installed_package_is_of_the_workspace_where_colcon_installed_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, endpoint: str
):
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)
    prefix = tmp_path / "install"
    share, programs = prefix / "share" / "turtlesim", prefix / "lib" / "turtlesim"
    for folder in (share, programs):
        folder.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>turtlesim</name></package>")
    (programs / "turtlesim_node").write_text('#!/bin/sh\necho built "$@"\nexit 3\n')
    (programs / "turtlesim_node").chmod(0o755)
    (prefix / "local_setup.sh").write_text("")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    with started(free_endpoint(), "run", "turtlesim", "turtlesim_node") as node:
        node.wait_for("Spawning turtle")
    (prefix / ".colcon_install_layout").write_text("merged\n")
    words = ("turtlesim", "turtlesim_node", "--ros-args", "-r", "a:=b")
    ran = studio_run(endpoint, *words, cwd=tmp_path)
    assert (ran.returncode, ran.stdout) == (3, "built --ros-args -r a:=b\n")


TALKER = """\
from std_msgs.msg import String
import rclpy
import sys
from rclpy.node import Node


def main(args=None):
    rclpy.init(args=args)
    node = Node("talker")
    publisher = node.create_publisher(String, "chatter", 10)
    publisher.publish(String(data="hello"))
    node.get_logger().info(f"Publishing on {publisher.topic_name}")
    print(sys.argv[0].rpartition("/")[2], sys.argv[1:], __name__)
    node.destroy_node()
    rclpy.shutdown()
    return 4
"""


@pytest.fixture
def own_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace with a Python package and one of interfaces that it uses, nothing built."""
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    source = tmp_path / "ws" / "src"
    modules = {
        "talker": TALKER,
        "telemetry": "import rclpy\nfrom my_own_interfaces.msg import Telemetry\n"
        "from helping.sums import double\n"
        "def main():\n    print(Telemetry(speed=double(1.5)))\n",
        "broken": "def helper():\n    raise ValueError('of mine')\n\n\ndef main():\n    helper()\n",
    }
    scripts = (
        "talker = own_pkg.talker:main",
        "telemetry = own_pkg.telemetry:main",
        "broken = own_pkg.broken:main",
    )
    python_package(source, "own_pkg", modules, *scripts)
    python_package(source, "helping", {"sums": "def double(x):\n    return 2 * x\n"})
    interfaces = source / "my_own_interfaces"
    (interfaces / "msg").mkdir(parents=True)
    (interfaces / "package.xml").write_text("<package><name>my_own_interfaces</name></package>")
    (interfaces / "msg" / "Telemetry.msg").write_text("float64 speed\n")
    return source


def test_an_entry_point_runs_as_ros2_run_runs_it(own_packages: Path, endpoint: str):
    words = ("own_pkg", "talker", "a", "--ros-args", "-r", "chatter:=/x")
    ran = studio_run(endpoint, *words, cwd=own_packages)
    assert ran.returncode == 4
    assert ran.stdout == "talker ['a', '--ros-args', '-r', 'chatter:=/x'] own_pkg.talker\n"
    assert ran.stderr.endswith("[talker]: Publishing on /x\n")


def test_interfaces_and_modules_of_other_packages_are_imported_without_a_build(
    own_packages: Path, endpoint: str
):
    ran = studio_run(endpoint, "own_pkg", "telemetry", cwd=own_packages)
    assert (ran.stdout, ran.stderr) == ("my_own_interfaces.msg.Telemetry(speed=3.0)\n", "")


def test_a_traceback_begins_with_the_users_own_code(own_packages: Path, endpoint: str):
    ran = studio_run(endpoint, "own_pkg", "broken", cwd=own_packages)
    head, first, *_ = ran.stderr.splitlines()
    assert (ran.returncode, head) == (1, "Traceback (most recent call last):")
    assert "own_pkg/broken.py" in first
    assert ran.stderr.endswith("ValueError: of mine\n")


def test_a_file_runs_as_python_runs_it(tmp_path: Path, endpoint: str):
    (tmp_path / "beside.py").write_text("NAME = 'beside'\n")
    (tmp_path / "own.py").write_text(
        "import sys\nimport beside\n"
        "print(__name__, __file__, sys.argv, sys.path[0] == sys.argv[1], beside.NAME)\n"
        "sys.exit(5)\n"
    )
    ran = studio_run(endpoint, "own.py", str(tmp_path), cwd=tmp_path)
    assert ran.returncode == 5
    assert ran.stdout == f"__main__ own.py ['own.py', '{tmp_path}'] True beside\n"


def test_a_package_alone_asks_for_its_executable():
    ran = studio("run", "turtlesim")
    assert (ran.code, "name an executable of the package" in ran.err) == (2, True)


@pytest.mark.parametrize("name", ["gone.py", "folder.py"])
def test_a_file_that_is_not_there_is_one_sentence(tmp_path: Path, name: str):
    (tmp_path / "folder.py").mkdir()
    ran = studio("run", str(tmp_path / name))
    assert (ran.code, ran.err.count("\n")) == (2, 1)
    assert "there is no such file" in ran.err
