"""`.rviz` files on the command line: refused before anything starts, or shown with their robot."""

from __future__ import annotations

from argparse import ArgumentParser
from pathlib import Path

import pytest

from studio.cli.view_files import add_view_options, is_view, read_view, robot_of
from tests.support.command_line import studio
from tests.support.server import running_studio
from tests.support.wire import wait_until

ROBOT = '<robot name="arm"><link name="base"/></robot>'


def view(source: str = "") -> str:
    described = f"\n      Description Source: File\n      Description File: {source}"
    return f"""Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Name: Robot
      Value: true{described if source else ""}
    - {{Class: moveit_rviz_plugin/MotionPlanning, Name: Planning, Value: true}}
  Global Options:
    Fixed Frame: odom
"""


def package(folder: Path) -> Path:
    """A package with a robot and its view."""
    made = folder / "arm_description"
    (made / "urdf").mkdir(parents=True)
    (made / "rviz").mkdir()
    (made / "package.xml").write_text("<package/>")
    (made / "urdf" / "arm.urdf").write_text(ROBOT)
    return made


@pytest.mark.parametrize("option", ["-d", "--display-config", "--rviz"])
def test_the_options_are_called_as_rviz_calls_them(option: str):
    parser = ArgumentParser()
    add_view_options(parser)
    options = parser.parse_args([option, "a.rviz", "-f", "odom", "--fullscreen"])
    assert (options.view, options.fixed_frame, options.fullscreen) == (Path("a.rviz"), "odom", True)


@pytest.mark.parametrize(
    "uri", ["../urdf/arm.urdf", "package://arm_description/urdf/arm.urdf", "{}/urdf/arm.urdf"]
)
def test_the_robot_that_a_view_names_is_found(tmp_path: Path, uri: str):
    made = package(tmp_path)
    file = made / "rviz" / "view.rviz"
    file.write_text(view(uri.format(made)))
    assert robot_of(read_view(file), tmp_path / "data").resolve() == made / "urdf" / "arm.urdf"
    assert is_view(file)
    assert not is_view(made)
    assert not is_view(None)


@pytest.mark.parametrize("uri", ["", "nowhere.urdf", "package://other/arm.urdf"])
def test_a_view_without_a_robot_stands_in_its_fixed_frame(tmp_path: Path, uri: str):
    made = package(tmp_path)
    file = made / "rviz" / "view.rviz"
    file.write_text(view(uri))
    found = robot_of(read_view(file), tmp_path)
    assert '<link name="odom"/>' in found.read_text()


def test_what_is_no_view_is_said_before_anything_starts(tmp_path: Path):
    file = tmp_path / "view.rviz"
    for words in (["open", str(file)], ["open", "-d", str(file)]):
        ran = studio(*words)
        assert ran.code == 2
        assert "No such file" in ran.err
    file.write_text("a: [")
    ran = studio("run", "rviz2", "rviz2", "-d", str(file), "--ros-args", "-r", "__node:=rviz")
    assert ran.code == 2
    assert "view.rviz" in ran.err
    file.write_bytes(b"\xff")
    assert "UTF-8" in studio("open", "robot.urdf", "--rviz", str(file)).err


@pytest.mark.network
def test_a_view_is_shown_with_its_robot_in_the_frame_of_the_command_line(tmp_path: Path):
    """It lies outside of the robot's package, and is saved there."""
    made = package(tmp_path / "src")
    file = tmp_path / "view.rviz"
    file.write_text(view(f"{made}/urdf/arm.urdf"))
    words = ["open", str(file), "--fixed-frame", "map", "--fullscreen", "--router", "off"]
    with running_studio(words, tmp_path / "data") as running:
        assert running.line.endswith("&fullscreen=1")
        wait_until("the losses", lambda: "MotionPlanning" in running.stderr)
        with running.client() as client:
            assert client.get("/?fullscreen=1&more=2").url.query == b"fullscreen=1"
            assert client.get("/?more=2").url.query == b""
            (document,) = client.get("/api/documents").json()["documents"]
            assert document["title"] == "arm.urdf"
            asked = {"type": "get_rviz_text", "document": document["id"], "request": 1}
            answer = client.post("/api/commands", json=asked).json()
            client.post("/api/commands", json=asked | {"type": "save_rviz_file"}).raise_for_status()
        assert "Fixed Frame: map" in file.read_text()
        (text,) = [one["text"] for one in answer["events"] if one["type"] == "rviz_text"]
        assert "Fixed Frame: map" in text
        assert "moveit_rviz_plugin/MotionPlanning" in text
