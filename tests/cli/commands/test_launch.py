from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import started, studio
from tests.support.launch_files import package_at
from tests.support.wire import free_endpoint

if TYPE_CHECKING:
    from pathlib import Path

_FILE = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('who', default_value='talker', description='Its name.',
                              choices=['talker', 'other']),
        DeclareLaunchArgument('bare'),
        Node(package='demo_nodes_py', executable='talker', name=LaunchConfiguration('who')),
        Node(package='gazebo_ros', executable='gz'),
    ])
"""


@pytest.fixture
def words(tmp_path: Path) -> tuple[str, ...]:
    package_at(tmp_path, "mine", {"launch/a.launch.py": _FILE})
    data = ("--package-path", str(tmp_path))
    return ("launch", "mine", "a.launch.py", *data)


def test_arguments_are_shown_as_ros2_launch_shows_them(words: tuple[str, ...]):
    ran = studio(*words, "--show-args")
    assert ran.code == 0
    assert ran.out == (
        "Arguments (pass arguments as '<name>:=<value>'):\n\n"
        "    'who':\n"
        "        Its name. Valid choices are: ['talker', 'other']\n"
        "        (default: 'talker')\n\n"
        "    'bare':\n"
        "        no description given\n"
        "        (no default: a value is needed)\n"
    )


def test_a_plan_is_printed_and_nothing_runs(words: tuple[str, ...]):
    ran = studio(*words, "--print", "who:=other", "typo:=1")
    assert ran.code == 0
    assert "/other  demo_nodes_py talker" in ran.out
    assert "not started: the studio has no physics" in ran.out
    assert "bare has no value" in ran.out
    assert "WARNING: typo is no argument of" in ran.err
    assert "it has bare, who" in ran.err


def test_a_plan_comes_as_json(words: tuple[str, ...]):
    ran = studio(*words, "--json", "bare:=1")
    plan = json.loads(ran.out)
    assert plan["package"] == "mine"
    assert [one["value"] for one in plan["arguments"]] == ["talker", "1"]


def test_lines_that_mean_something_else_are_sentences(words: tuple[str, ...]):
    ran = studio("launch", "talker")
    assert (ran.code, ran.out) == (2, "")
    assert "is no launch file" in ran.err or "is a node" in ran.err
    ran = studio(*words[:3], "who:=", "=", *words[3:])
    assert "is one word too many" in ran.err
    ran = studio(*words[:3], "who", ":=", "me", *words[3:])
    assert "has no name: write NAME:=VALUE, without blanks" in ran.err


def test_a_plan_with_a_fault_says_it_once_and_exits_with_1(tmp_path: Path):
    file = tmp_path / "a.launch.xml"
    file.write_text('<launch><include file="/no/such.launch.py"/></launch>\n')
    ran = studio("launch", str(file), "--print")
    assert ran.code == 1
    assert "/no/such.launch.py  (not read)" in ran.out
    assert ran.out.count("there is no such launch file") == 1


@pytest.mark.network
def test_a_name_that_is_no_argument_is_said_in_a_run_too(tmp_path: Path):
    file = tmp_path / "a.launch.xml"
    file.write_text('<launch><arg name="who" default="me"/><log message="hi"/></launch>\n')
    with started(free_endpoint(), "launch", str(file), "whom:=you") as launch:
        assert launch.wait() == 0
    assert f"[WARNING] [launch]: whom is no argument of {file}: it has who" in launch.printed


@pytest.mark.network
def test_an_argument_that_needs_a_value_is_asked_for(words: tuple[str, ...]):
    with started(free_endpoint(), *words) as launch:
        assert launch.wait() == 1
    assert "the argument bare has no value and no default: give bare:=..." in launch.printed


@pytest.mark.network
def test_a_launch_file_runs_until_ctrl_c(words: tuple[str, ...]):
    with started(free_endpoint(), *words, "bare:=1", "who:=other") as launch:
        launch.wait_for("[other]: Publishing")
        assert launch.stop() == 0
    assert "gazebo_ros gz is not started" in launch.printed
