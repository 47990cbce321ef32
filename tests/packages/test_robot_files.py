"""Which files are offered as robots."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from studio.packages.robot_files import Candidate, robot_candidates
from studio.packages.roots import ServedRoots
from tests.support.corpus import corpus
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

HEAD = '<robot xmlns:xacro="http://ros.org/wiki/xacro"'
MACROS = f'{HEAD}><xacro:macro name="m"><link name="a"/></xacro:macro></robot>'
CALLS = f'{HEAD} name="rover"><xacro:m/></robot>'


def found(folder: Path) -> dict[str, Candidate]:
    """Entry points by file name, in their order."""
    return {one.path.name: one for one in robot_candidates(folder, ServedRoots([folder]))}


def write(folder: Path, files: dict[str, str]) -> Path:
    return write_package(folder / "rover_description", files=files)


def test_a_robot_is_offered_with_its_name_kind_and_package(tmp_path: Path):
    write(
        tmp_path, {"urdf/a.urdf.xacro": CALLS, "b.urdf": "<robot name='b'><link name='l'/></robot>"}
    )
    points = found(tmp_path)
    assert points["a.urdf.xacro"].title == "rover"
    assert points["a.urdf.xacro"].kind == "xacro"
    assert points["b.urdf"].kind == "urdf"
    assert {one.package for one in points.values()} == {"rover_description"}
    assert all(one.openable and one.reason == "" for one in points.values())


def test_a_robot_with_a_fault_in_its_xml_can_be_opened_and_is_offered_last(tmp_path: Path):
    broken = CALLS.replace("</robot>", "</robt>")
    write(tmp_path, {"rover.urdf.xacro": broken, "other.xacro": CALLS, "m.xacro": MACROS[:-3]})
    points = found(tmp_path)
    assert list(points) == ["other.xacro", "rover.urdf.xacro", "m.xacro"]
    assert [one.openable for one in points.values()] == [True, True, False]


def test_the_suffix_does_not_tell_what_is_xacro(tmp_path: Path):
    write(tmp_path, {"a.urdf": CALLS, "b.xacro": "<robot name='b'><link name='l'/></robot>"})
    points = found(tmp_path)
    assert (points["a.urdf"].kind, points["b.xacro"].kind) == ("xacro", "urdf")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (MACROS, "only macros, meant to be included"),
        (
            f'{HEAD}><xacro:property name="p" value="1"/></robot>',
            "holds no link and calls no macro",
        ),
        ("<gazebo/>", "root is <gazebo>"),
        ("", "not readable: empty"),
        ("<robot>", "not readable: not well-formed XML: no element found, line 1"),
    ],
)
def test_what_is_no_robot_says_why(tmp_path: Path, text: str, reason: str):
    write(tmp_path, {"a.xacro": text})
    point = found(tmp_path)["a.xacro"]
    assert not point.openable
    assert point.reason == reason


@pytest.mark.parametrize(
    "written",
    [
        "parts/wheel.xacro",
        "$(find rover_description)/parts/wheel.xacro",
        "file://$(find rover_description)/parts/wheel.xacro",
        "package://rover_description/parts/wheel.xacro",
        "${folder}/parts/wheel.xacro",
        "$(arg folder)/wheel.xacro",
    ],
)
def test_a_nameless_file_that_another_includes_is_a_part(tmp_path: Path, written: str):
    part = f'{HEAD}><link name="wheel"/></robot>'
    entry = f'{HEAD} name="r"><xacro:include filename="{written}"/><link name="b"/></robot>'
    write(tmp_path, {"robot.xacro": entry, "parts/wheel.xacro": part, "alone.xacro": part})
    points = found(tmp_path)
    assert points["wheel.xacro"].reason == "included by robot.xacro"
    assert points["alone.xacro"].openable


def test_a_named_file_stays_a_robot_though_it_is_included(tmp_path: Path):
    entry = f'{HEAD} name="r"><xacro:include filename="b.xacro"/><link name="b"/></robot>'
    write(tmp_path, {"a.xacro": entry, "b.xacro": f'{HEAD} name="b"><link name="l"/></robot>'})
    assert [one.openable for one in found(tmp_path).values()] == [True, True]


def test_a_file_that_only_includes_parts_with_links_is_a_robot(tmp_path: Path):
    def including(name: str, target: str) -> str:
        return f'{HEAD} {name}><xacro:include filename="{target}"/></robot>'

    write(
        tmp_path,
        {
            "robot.xacro": including('name="r"', "middle.xacro"),
            "middle.xacro": including("", "core.xacro"),
            "core.xacro": f'{HEAD}><link name="l"/></robot>',
            "only_macros.xacro": including('name="m"', "macros.xacro"),
            "macros.xacro": MACROS,
            "elsewhere.xacro": including('name="e"', "$(find other)/robot.xacro"),
            "loop.xacro": including('name="l"', "loop2.xacro"),
            "loop2.xacro": including('name="l"', "loop.xacro"),
        },
    )
    points = found(tmp_path)
    assert points["robot.xacro"].openable
    assert points["elsewhere.xacro"].openable
    assert points["only_macros.xacro"].reason == "includes only macros and properties"
    assert points["loop.xacro"].reason == "includes only macros and properties"


def test_an_srdf_is_no_robot_description(tmp_path: Path):
    write(tmp_path, {"arm.srdf.xacro": CALLS})
    assert "SRDF" in found(tmp_path)["arm.srdf.xacro"].reason


def test_xml_files_are_listed_only_when_they_are_robots(tmp_path: Path):
    write(tmp_path, {"a.xml": CALLS, "go.launch.xml": "<launch/>"})
    assert list(found(tmp_path)) == ["a.xml"]


def test_the_best_file_comes_first(tmp_path: Path):
    write(
        tmp_path,
        {
            "urdf/rover.urdf.xacro": CALLS,
            "urdf/rover_with_arm.urdf.xacro": CALLS,
            "urdf/aaa.urdf.xacro": CALLS,
            "rover.urdf": "<robot name='r'><link name='l'/></robot>",
            "test/rover.urdf.xacro": CALLS,
            "urdf/macros.xacro": MACROS,
        },
    )
    points = robot_candidates(tmp_path, ServedRoots([tmp_path]))
    names = [str(one.path.relative_to(tmp_path / "rover_description")) for one in points]
    assert names[0] == "urdf/rover.urdf.xacro"
    assert names[1] == "rover.urdf"
    assert names[-2:] == ["test/rover.urdf.xacro", "urdf/macros.xacro"]


def test_a_description_package_comes_before_others(tmp_path: Path):
    write_package(tmp_path / "a_bringup", files={"a.urdf.xacro": CALLS})
    write_package(tmp_path / "z_description", files={"b/c/other.urdf.xacro": CALLS})
    points = robot_candidates(tmp_path, ServedRoots([tmp_path]))
    assert points[0].package == "z_description"


def test_built_hidden_and_ignored_folders_are_left_out(tmp_path: Path):
    write(tmp_path, {"a.xacro": CALLS})
    for folder in ("build", "install", ".git", "old"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "b.xacro").write_text(CALLS)
    (tmp_path / "old" / "COLCON_IGNORE").touch()
    assert list(found(tmp_path)) == ["a.xacro"]


@pytest.mark.skipif(os.name == "nt", reason="symlinks and pipes of Unix")
def test_pipes_and_links_that_lead_outside_are_not_readable(tmp_path: Path):
    (tmp_path / "secret.urdf").write_text("<robot name='secret'><link name='l'/></robot>")
    opened = tmp_path / "opened"
    opened.mkdir()
    os.mkfifo(opened / "pipe.urdf")
    (opened / "link.urdf").symlink_to(tmp_path / "secret.urdf")
    points = found(opened)
    assert points["pipe.urdf"].reason.startswith("not readable: is no regular file")
    assert points["link.urdf"].reason.startswith("not readable: lies outside")
    assert "secret" not in {one.title for one in points.values()}


def test_progress_is_told(tmp_path: Path):
    write(tmp_path, {"a.xacro": CALLS, "b.xacro": MACROS})
    told: list[tuple[int, int]] = []
    robot_candidates(tmp_path, ServedRoots([tmp_path]), lambda done, of: told.append((done, of)))
    assert told == [(1, 2), (2, 2)]


FIRST_OF_REPOSITORY = {
    "ANYbotics+anymal_c_simple_description": "urdf/anymal.urdf",
    "Kinovarobotics+ros2_kortex": "kortex_description/robots/kinova.urdf.xacro",
    "PR2+pr2_common": "pr2_description/robots/pr2.urdf.xacro",
    "PickNikRobotics+ros2_robotiq_gripper": (
        "robotiq_description/urdf/robotiq_2f_140_gripper.urdf.xacro"
    ),
    "ROBOTIS-GIT+turtlebot3": "turtlebot3_description/urdf/turtlebot3_burger.urdf",
    "UniversalRobots+Universal_Robots_ROS2_Description": "urdf/ur.urdf.xacro",
    "husky+husky": "husky_description/urdf/husky.urdf.xacro",
    "iRobotEducation+create3_sim": (
        "irobot_create_common/irobot_create_description/urdf/create3.urdf.xacro"
    ),
    "joshnewans+articubot_one": "description/robot.urdf.xacro",
    "shadow-robot+sr_common": "sr_description/robots/sr_hand.urdf.xacro",
    "turtlebot+turtlebot4": "turtlebot4_description/urdf/lite/turtlebot4.urdf.xacro",
    "xArm-Developer+xarm_ros2": "xarm_description/urdf/xarm_device.urdf.xacro",
}


@pytest.mark.corpus
def test_every_real_repository_offers_a_robot_first():
    folder = corpus()
    missing = [
        one.name
        for one in sorted(folder.iterdir())
        if one.is_dir() and not robot_candidates(one, ServedRoots([one]))[0].openable
    ]
    assert missing == []


@pytest.mark.corpus
@pytest.mark.parametrize("repository", FIRST_OF_REPOSITORY)
def test_the_first_robot_of_a_real_repository_is_the_one_a_person_would_open(repository: str):
    folder = corpus() / repository
    best = robot_candidates(folder, ServedRoots([folder]))[0]
    assert str(best.path.relative_to(folder)) == FIRST_OF_REPOSITORY[repository]


@pytest.mark.corpus
def test_the_robots_of_the_corpus_are_counted():
    folder = corpus()
    points = robot_candidates(folder, ServedRoots([folder]))
    assert (sum(one.openable for one in points), len(points)) == (109, 537)
