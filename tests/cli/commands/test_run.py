from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import comes_to, started, studio
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
    (package / "setup.py").write_text("d = {'console_scripts': ['mine = own_pkg.mine:main']}")
    monkeypatch.chdir(tmp_path)
    for words, said in (
        (("no_such", "x"), 'No package "no_such"'),
        (("turtlesim", "x"), "it has turtle_teleop_key, turtlesim_node"),
        (("own_pkg", "mine"), "own_pkg.mine:main, but no file of the package is the module"),
        (("own_pkg", "other"), 'has no executable "other": it has mine.'),
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
    (python / "learning_interface" / "own_server.py").write_text(SERVER)
    cmake = tmp_path / "ws" / "src" / "demo_nodes_py"
    (cmake / "src").mkdir(parents=True)
    (cmake / "src" / "talker.cpp").write_text("int main() {}\n")
    (cmake / "package.xml").write_text("<package><name>demo_nodes_py</name></package>")
    (cmake / "CMakeLists.txt").write_text(CMAKE)
    return tmp_path / "ws"


@pytest.mark.parametrize("inside", [True, False])
def test_a_node_of_the_workspace_comes_before_the_demo_of_its_name_and_is_only_told(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, inside: bool
):
    monkeypatch.chdir(workspace if inside else workspace.parent)
    named = [] if inside else ["--package-path", str(workspace / "src")]
    ran = studio("run", "learning_interface", "server", *named)
    package = workspace / "src" / "learning_interface"
    assert (ran.code, ran.out) == (2, "")
    assert f"the package is {package}, " in ran.err
    assert f"would start main() in {package / 'learning_interface' / 'own_server.py'}." in ran.err
    assert ran.err.endswith("starts with: studio run --demo learning_interface server\n")


def test_programs_of_a_cmake_package_come_before_the_demo_too(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(workspace / "src")
    ran = studio("run", "demo_nodes_py", "talker")
    assert ran.code == 2
    assert f"would start {workspace / 'src/demo_nodes_py/src/talker.cpp'}." in ran.err
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
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("STUDIO_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)
    prefix = tmp_path / "install"
    share, programs = prefix / "share" / "turtlesim", prefix / "lib" / "turtlesim"
    for folder in (share, programs):
        folder.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>turtlesim</name></package>")
    (programs / "turtlesim_node").write_text("#!/bin/sh\n")
    (programs / "turtlesim_node").chmod(0o755)
    (prefix / "local_setup.sh").write_text("")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    with started(free_endpoint(), "run", "turtlesim", "turtlesim_node") as node:
        node.wait_for("Spawning turtle")
    (prefix / ".colcon_install_layout").write_text("merged\n")
    ran = studio("run", "turtlesim", "turtlesim_node")
    assert (ran.code, str(programs / "turtlesim_node") in ran.err) == (2, True)
