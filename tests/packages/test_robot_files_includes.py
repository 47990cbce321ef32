"""The include graph, told from texts alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from studio.packages.robot_files import Includes, Outline

ROVER = ("rover", Path("/ws/rover"))


def graph(**includes: list[str]) -> Includes:
    """Files of the rover package by stem, each with what it includes; `core` has content."""
    outlines = {
        Path(f"/ws/rover/urdf/{name}.xacro"): Outline(
            "robot", name="", has_content=name == "core", includes=written
        )
        for name, written in includes.items()
    }
    return Includes(outlines, dict.fromkeys(outlines, ROVER))


def path(name: str) -> Path:
    return Path(f"/ws/rover/urdf/{name}.xacro")


@pytest.mark.parametrize(
    "written",
    [
        "core.xacro",
        "./core.xacro",
        "../urdf/core.xacro",
        " $(find rover)/urdf/core.xacro ",
        "$(find  rover )/urdf/core.xacro",
        "package://rover/urdf/core.xacro",
        "file://$(find rover)/urdf/core.xacro",
        "$(arg place)/urdf/core.xacro",
        "${place}/core.xacro",
        "$(find other)/${kind}/core.xacro",
    ],
)
def test_an_include_is_found_however_it_is_written(written: str):
    includes = graph(top=[written], core=[])
    assert includes.includers(path("core")) == [path("top")]
    assert includes.bring_content(path("top"))


@pytest.mark.parametrize("written", ["other.xacro", "", "$(arg file)", "${kind}.xacro", "*.xacro"])
def test_an_include_that_cannot_be_told_brings_nothing_to_a_nameless_file(written: str):
    includes = graph(top=[written], core=[])
    assert includes.includers(path("core")) == []
    assert not includes.bring_content(path("top"))


def test_content_comes_over_several_steps_and_around_loops():
    includes = graph(a=["b.xacro"], b=["a.xacro", "c.xacro"], c=["core.xacro", "b.xacro"], core=[])
    assert includes.bring_content(path("a"))
    assert not graph(a=["b.xacro"], b=["a.xacro"]).bring_content(path("a"))


def test_a_file_that_includes_itself_is_not_its_own_includer():
    assert graph(a=["a.xacro"]).includers(path("a")) == []
