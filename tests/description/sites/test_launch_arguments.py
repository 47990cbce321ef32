"""What a robot can be launched with: real robots, and small ones that do not run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.sites.launch_arguments import LaunchArgument, launch_arguments
from studio.description.values import WidgetKind
from studio.documents.arguments import RoomWorld
from studio.packages.workspace import open_location
from tests.support.corpus import corpus
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


def found(entry: Path, data: Path, *paths: Path, **given: str) -> dict[str, LaunchArgument]:
    location = open_location(entry, paths, data, {})
    assert location.entry is not None
    listed = launch_arguments(str(location.entry), given, RoomWorld(location, {}))
    return {one.name: one for one in listed}


def robot(tmp_path: Path, body: str, **files: str) -> Path:
    texts = {"r.urdf.xacro": f"{HEAD}{body}</robot>", **files}
    return write_package(tmp_path / "ws" / "r_description", files=texts) / "r.urdf.xacro"


def test_an_arg_without_a_declaration_is_asked_for_and_comes_first(tmp_path: Path):
    body = '<xacro:arg name="size" default="1.0"/><link name="$(arg side)"/>'
    listed = found(robot(tmp_path, body), tmp_path / "data")
    assert list(listed) == ["side", "size"]
    assert (listed["side"].default, listed["side"].place.line) == (None, 1)
    assert (listed["size"].default, listed["size"].widget.kind) == ("1.0", WidgetKind.SLIDER)


def test_an_arg_of_an_included_file_is_listed_though_the_entry_is_broken_xacro(tmp_path: Path):
    body = '<xacro:include filename="$(find r_description)/part.xacro"/><xacro:nothing/>'
    part = f'{HEAD}<xacro:arg name="tool" default="none"/></robot>'
    entry = robot(tmp_path, body, **{"part.xacro": part})
    listed = found(entry, tmp_path / "data")
    assert listed["tool"].place.file.endswith("part.xacro")


@pytest.mark.parametrize(
    "condition",
    ["${'$(arg a)' == 'one'}", "${p == 'one'}", "${'one' == p}", "${p in ['one']}"],
)
def test_what_a_condition_compares_with_is_a_choice(tmp_path: Path, condition: str):
    body = (
        '<xacro:arg name="a" default="two"/><xacro:property name="p" value="$(arg a)"/>'
        f'<xacro:if value="{condition}"><link name="x"/></xacro:if>'
    )
    widget = found(robot(tmp_path, body), tmp_path / "data")["a"].widget
    assert (widget.kind, widget.choices) == (WidgetKind.CHOICE, ("two", "one"))


def test_an_arg_that_is_a_condition_itself_is_a_switch(tmp_path: Path):
    body = '<xacro:if value="$(arg sim)"><link name="x"/></xacro:if>'
    assert found(robot(tmp_path, body), tmp_path / "data")["sim"].widget.kind is WidgetKind.SWITCH


def test_folders_outside_of_what_is_served_are_no_choices(tmp_path: Path):
    outside = tmp_path / "outside"
    for name in ("one", "two"):
        (outside / name).mkdir(parents=True)
    include = f'<xacro:include filename="{outside}/$(arg a)/x.xacro"/>'
    listed = found(robot(tmp_path, include), tmp_path / "data")
    assert listed["a"].widget.choices == ()


def test_a_comment_says_what_it_is_for_and_may_give_the_choices(tmp_path: Path):
    body = '\n<!-- [left, right] which arm it is -->\n<xacro:arg name="arm" default="left"/>\n'
    widget = found(robot(tmp_path, body), tmp_path / "data")["arm"].widget
    assert (widget.choices, widget.help) == (("left", "right"), "which arm it is")


def test_args_that_are_made_of_each_other_end(tmp_path: Path):
    body = '<xacro:arg name="a" default="$(arg b)/x"/><xacro:arg name="b" default="$(arg a)/y"/>'
    assert found(robot(tmp_path, body), tmp_path / "data")["a"].shown == ""


def test_what_the_root_element_reads_is_needed_though_it_is_declared_below(tmp_path: Path):
    entry = robot(tmp_path, '<xacro:arg name="size" default="1"/><link name="$(arg size)"/>')
    text = entry.read_text().replace('name="r"', 'name="$(arg name)"', 1)
    entry.write_text(text.replace("</robot>", '<xacro:arg name="name" default="ur"/></robot>'))
    listed = found(entry, tmp_path / "data")
    assert (listed["name"].is_early, listed["name"].default) == (True, "ur")
    assert not listed["size"].is_early


def test_urs_types_are_the_folders_of_its_configuration(tmp_path: Path):
    entry = corpus() / "UniversalRobots+Universal_Robots_ROS2_Description/urdf/ur.urdf.xacro"
    listed = found(entry, tmp_path, ur_type="ur10e")
    choices = listed["ur_type"].widget.choices
    assert {"ur3", "ur5e", "ur10e", "ur20"} <= set(choices)
    assert choices.index("ur5") < choices.index("ur10")
    assert listed["joint_limit_params"].shown.endswith("/config/ur10e/joint_limits.yaml")
    assert listed["joint_limit_params"].is_file
    assert listed["safety_limits"].widget.kind is WidgetKind.SWITCH
    assert listed["safety_pos_margin"].default == "0.15"


@pytest.mark.parametrize(
    ("path", "name", "choices"),
    [
        ("Kinovarobotics+ros2_kortex/kortex_description/robots/gen3.xacro", "dof", ("6", "7")),
        (
            "Kinovarobotics+ros2_kortex/kortex_description/robots/gen3.xacro",
            "arm",
            ("gen3", "gen3_lite"),
        ),
        (
            "xArm-Developer+xarm_ros2/xarm_description/urdf/xarm_device.urdf.xacro",
            "geometry_type",
            ("box", "mesh", "sphere", "cylinder"),
        ),
        (
            "turtlebot+turtlebot4/turtlebot4_description/urdf/standard/turtlebot4.urdf.xacro",
            "gazebo",
            ("classic", "ignition"),
        ),
        (
            "iRobotEducation+create3_sim/irobot_create_common/irobot_create_description"
            "/urdf/create3.urdf.xacro",
            "gazebo",
            ("classic", "ignition"),
        ),
    ],
)
def test_real_robots_offer_what_they_tell_apart(
    tmp_path: Path, path: str, name: str, choices: tuple[str, ...]
):
    listed = found(corpus() / path, tmp_path, corpus())
    assert listed[name].widget.choices == choices
