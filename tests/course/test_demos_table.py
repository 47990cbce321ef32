from __future__ import annotations

import importlib
import importlib.util

import pytest

from studio.course.demos import DEMOS, Demo, executables, find_demo

BY_NAME = [pytest.param(demo, id=demo.name) for demo in DEMOS]


@pytest.mark.parametrize("demo", BY_NAME)
def test_a_demo_is_there_and_says_what_it_shows_and_what_to_try(demo: Demo):
    assert importlib.util.find_spec(demo.module) is not None
    assert 10 < len(demo.shows) < 100
    assert "`studio" in demo.to_try
    assert find_demo(demo.name) is demo


@pytest.mark.parametrize("module", sorted(set(executables().values())))
def test_what_an_executable_starts_has_a_main(module: str):
    assert callable(importlib.import_module(module).main)


def test_the_course_names_its_executables():
    """Those that its pages start with `ros2 run`."""
    known = executables()
    for pair in (
        ("turtlesim", "turtlesim_node"),
        ("turtlesim", "turtle_teleop_key"),
        ("radio_station", "service_server"),
        ("radio_station", "radio_dj"),
        ("radio_station", "song_requester"),
        ("py_pkg_node", "print_forever_node"),
        ("urdf_view", "state_publisher"),
    ):
        assert pair in known


def test_no_executable_has_two_demos():
    pairs = [pair for demo in DEMOS for pair in demo.executables]
    assert len(pairs) == len(set(pairs)) == len(executables())


def test_a_demo_is_found_by_the_name_of_its_executable_too():
    found = find_demo("song_requester"), find_demo("my_tiny_sub"), find_demo("no_such")
    assert [demo and demo.name for demo in found] == ["song_requester", "number_counter", None]
