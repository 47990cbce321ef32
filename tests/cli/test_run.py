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
        (("own_pkg", "mine"), "is a program of ROS (own_pkg.mine:main)"),
        (("rover_description", "x"), "starts nothing"),
    ):
        ran = studio("run", *words)
        assert ran.code == 2
        assert said in ran.err
        assert ran.err.count("\n") == 1


def test_xacro_is_a_command_of_the_studio(tmp_path: Path):
    robot = tmp_path / "r.xacro"
    robot.write_text('<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="${1 + 1}"/>')
    with started("tcp/127.0.0.1:1", "run", "xacro", "xacro", str(robot)) as expanded:
        assert expanded.wait() == 0
    assert 'name="2"' in expanded.printed
