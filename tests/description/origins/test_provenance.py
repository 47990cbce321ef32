"""Where parts come from: calls, conditions, and what each number is made of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.origins.origin_values import InputKind
from studio.description.origins.provenance import INPUTS_KEPT
from studio.description.values import SiteKind
from tests.support.corpus import corpus
from tests.support.descriptions import robot, write
from tests.support.traced_robots import TracedRobot, attribute, behind, way_to

if TYPE_CHECKING:
    from pathlib import Path


def opened(folder: Path, body: str, **arguments: str) -> TracedRobot:
    return TracedRobot(write(folder, {"a.xacro": robot(body)}), None, **arguments)


def test_a_number_leads_through_the_macro_to_the_property_that_can_be_edited(tmp_path: Path):
    body = (
        '<xacro:property name="size" value="0.1"/>\n'
        '<xacro:macro name="wheel" params="side r:=${size}">\n'
        '  <link name="${side}"><visual><geometry><sphere radius="${r * 2}"/></geometry></visual>'
        "</link></xacro:macro>\n"
        '<xacro:wheel side="left"/>\n<xacro:wheel side="right" r="${size / 2}"/>'
    )
    rover = opened(tmp_path, body)
    left, right = rover.origin("link:left"), rover.origin("link:right")
    at = "visual/geometry/sphere", "radius"
    assert attribute(left, *at).value == "0.2"
    assert attribute(left, *at).text == "${r * 2}"
    assert attribute(left, *at).unit == "m"
    assert way_to(left, *at) == [("param_default", "r"), ("property", "size")]
    assert way_to(right, *at) == [("parameter", "r"), ("property", "size")]
    default, size = behind(left, attribute(left, *at))
    assert default.value == size.value == "0.1"
    assert size.site == rover.site("size").id
    assert default.site == rover.site("r", SiteKind.PARAM_DEFAULT).id
    given, _ = behind(right, attribute(right, *at))
    assert (given.text, given.value, given.site) == ("${size / 2}", "0.05", "")
    (call,) = right.calls
    assert (call.macro, call.called_at.line, call.defined_at.line) == ("wheel", 5, 2)
    bound = [right.inputs[one] for one in call.arguments]
    assert [(one.name, one.value) for one in bound] == [("side", "right"), ("r", "0.05")]


def test_the_place_of_a_number_is_its_text_not_its_tag(tmp_path: Path):
    body = '<link name="ä"\n  ><inertial>\r\n<mass\n\n   value="${ 1 + 1 }"/></inertial></link>'
    (mass,) = [a for a in opened(tmp_path, body).origin("link:ä").attributes if a.unit == "kg"]
    assert (mass.place.line, mass.place.column) == (5, 11)
    assert mass.value == "2"


def test_each_reader_of_a_redefined_property_is_told_its_own_definition(tmp_path: Path):
    body = (
        '<xacro:property name="x" value="1"/><link name="a"><mass value="${x}"/></link>'
        '<xacro:property name="x" value="2"/><link name="b"><mass value="${x}"/></link>'
    )
    rover = opened(tmp_path, body)
    texts = [
        behind(o, attribute(o, "mass", "value")) for o in map(rover.origin, ("link:a", "link:b"))
    ]
    assert [[one.text for one in found] for found in texts] == [["1"], ["2"]]


def test_a_parameter_shadows_the_property_of_its_name(tmp_path: Path):
    body = (
        '<xacro:property name="x" value="1"/>'
        '<xacro:macro name="m" params="x"><link name="a"><mass value="${x}"/></link></xacro:macro>'
        '<xacro:m x="7"/>'
    )
    origin = opened(tmp_path, body).origin("link:a")
    assert way_to(origin, "mass", "value") == [("parameter", "x")]


def test_a_recursive_macro_is_told_apart_at_each_depth(tmp_path: Path):
    body = (
        '<xacro:macro name="chain" params="n"><xacro:if value="${n > 0}">'
        '<link name="l${n}"><mass value="${n}"/></link><xacro:chain n="${n - 1}"/></xacro:if>'
        '</xacro:macro><xacro:chain n="3"/>'
    )
    origin = opened(tmp_path, body).origin("link:l1")
    values = [one.value for one in behind(origin, attribute(origin, "mass", "value"))]
    assert values == ["1", "2", "3"]
    assert [call.macro for call in origin.calls] == ["chain"] * 3
    assert [cause.tag for cause in origin.causes] == ["xacro:if"] * 3


def test_an_inserted_block_keeps_where_its_numbers_were_written(tmp_path: Path):
    body = (
        '<xacro:property name="h" value="0.3"/>\n'
        '<xacro:macro name="m" params="name *origin"><joint name="${name}" type="fixed">'
        '<xacro:insert_block name="origin"/></joint></xacro:macro>\n'
        '<xacro:m name="j"><origin xyz="0 0 ${h}"/></xacro:m>'
    )
    origin = opened(tmp_path, body).origin("joint:j")
    found = attribute(origin, "origin", "xyz")
    assert (found.value, found.text, found.place.line) == ("0 0 0.3", "0 0 ${h}", 3)
    assert way_to(origin, "origin", "xyz") == [("property", "h")]


def test_a_condition_around_a_part_is_a_cause_with_its_inputs(tmp_path: Path):
    body = (
        '<xacro:arg name="gripper" default="true"/>'
        '<xacro:if value="$(arg gripper)"><link name="a"/></xacro:if><link name="b"/>'
    )
    rover = opened(tmp_path, body, gripper="1")
    (cause,) = rover.origin("link:a").causes
    (arg,) = [rover.origin("link:a").inputs[one] for one in cause.inputs]
    assert (cause.tag, cause.text) == ("xacro:if", "$(arg gripper)")
    assert (arg.kind, arg.name, arg.value, arg.given) == (InputKind.ARG, "gripper", "1", True)
    assert rover.origin("link:b").causes == ()


def test_what_an_included_macro_makes_is_there_because_of_the_file_that_was_chosen(tmp_path: Path):
    main = robot(
        '<xacro:arg name="kind" default="big"/><xacro:include filename="$(arg kind).xacro"/>'
        "<xacro:part/>"
    )
    big = robot('<xacro:macro name="part"><link name="big"/></xacro:macro>')
    file = write(tmp_path, {"a.xacro": main, "big.xacro": big})
    origin = TracedRobot(file).origin("link:big")
    assert [cause.tag for cause in origin.causes] == ["xacro:include"]
    assert [place.file for place in origin.include_chain] == [str(file)]
    assert origin.place.file == str(tmp_path / "big.xacro")


def test_a_set_attribute_is_told_where_it_is_set(tmp_path: Path):
    body = (
        '<xacro:property name="m" value="3"/>\n'
        '<link name="a"><mass value="1">\n'
        '<xacro:attribute name="value" value="${m}.5"/></mass></link>'
    )
    origin = opened(tmp_path, body).origin("link:a")
    found = attribute(origin, "mass", "value")
    assert (found.value, found.place.line) == ("3.5", 3)
    assert way_to(origin, "mass", "value") == [("property", "m")]


def test_a_text_is_told_like_an_attribute(tmp_path: Path):
    body = '<xacro:property name="ns" value="x"/><gazebo><topic>/${ns}/scan</topic></gazebo>'
    origin = opened(tmp_path, body).origin("other:0")
    found = attribute(origin, "topic", "")
    assert (found.value, found.text) == ("/x/scan", "/${ns}/scan")
    assert way_to(origin, "topic", "") == [("property", "ns")]


def test_a_yaml_value_is_told_through_aliases_where_it_is_written(tmp_path: Path):
    body = (
        '<xacro:property name="c" value="${xacro.load_yaml(\'c.yaml\')}"/>'
        '<link name="a"><mass value="${c.rear.mass}"/></link>'
    )
    yaml = "front: &f\n  mass: 4.5\nrear: *f\n"
    rover = TracedRobot(write(tmp_path, {"a.xacro": robot(body), "c.yaml": yaml}))
    origin = rover.origin("link:a")
    (value,) = [one for one in origin.inputs if one.kind is InputKind.YAML]
    assert (value.name, value.value, value.place.line) == ("front.mass", "4.5", 2)
    assert value.site == rover.site("front.mass", SiteKind.YAML).id


def test_many_inputs_are_cut_and_it_is_said(tmp_path: Path):
    names = [f"p{n}" for n in range(INPUTS_KEPT + 5)]
    body = "".join(f'<xacro:property name="{name}" value="1"/>' for name in names)
    body += f'<link name="a"><mass value="${{{"+".join(names)}}}"/></link>'
    origin = opened(tmp_path, body).origin("link:a")
    assert len(origin.inputs) == INPUTS_KEPT
    assert origin.is_cut


def test_a_deep_chain_of_properties_is_followed_to_its_end(tmp_path: Path):
    body = '<xacro:property name="p0" value="1"/>' + "".join(
        f'<xacro:property name="p{n}" value="${{p{n - 1}}}"/>' for n in range(1, 300)
    )
    body += '<link name="a"><mass value="${p299}"/></link>'
    origin = opened(tmp_path, body).origin("link:a")
    assert len(origin.inputs) == 300
    assert not origin.is_cut


def check_values(traced: TracedRobot) -> None:
    """Every attribute of every part is told, with the value that the part has."""
    told = {
        (part, one.element, one.attribute): one.value
        for part in traced.parts
        for one in traced.origin(part).attributes
    }
    cut = {key for key, value in told.items() if value.endswith("...")}
    there = {key: value for key, value in traced.attributes().items() if key not in cut}
    assert {key: told.get(key) for key in there} == there


def test_what_is_told_follows_every_edit(tmp_path: Path):
    body = (
        '<xacro:property name="a" value="1"/><xacro:property name="b" value="${a}"/>'
        '<link name="x"><mass value="${b}"/></link><link name="y"><mass value="2"/></link>'
    )
    traced = opened(tmp_path, body)
    data = (tmp_path / "a.xacro").read_bytes()
    for old, new in ((b'"1"', b'"7"'), (b'"${a}"', b'"${a * 2}"'), (b'"2"', b'"${b}"')):
        start = data.index(old)
        traced.edit(str(tmp_path / "a.xacro"), start, start + len(old), new)
        data = data[:start] + new + data[start + len(old) :]
        check_values(traced)
    origin = traced.origin("link:y")
    assert way_to(origin, "mass", "value") == [("property", "b"), ("property", "a")]
    assert attribute(origin, "mass", "value").value == "14"


def test_every_attribute_of_real_robots_is_told():
    folder = corpus()
    arm = folder / "UniversalRobots+Universal_Robots_ROS2_Description" / "urdf" / "ur.urdf.xacro"
    check_values(TracedRobot(arm, arm.parents[1], ur_type="ur10e", name="ur"))
    burger = folder / "ROBOTIS-GIT+turtlebot3" / "turtlebot3_description" / "urdf"
    check_values(TracedRobot(burger / "turtlebot3_burger.urdf", burger.parents[1], namespace=""))
    pr2 = folder / "PR2+pr2_common" / "pr2_description" / "robots" / "pr2.urdf.xacro"
    check_values(TracedRobot(pr2, pr2.parents[2]))


def test_the_elbow_of_a_real_arm_leads_to_a_key_of_its_yaml_file():
    folder = corpus() / "UniversalRobots+Universal_Robots_ROS2_Description"
    arm = TracedRobot(folder / "urdf" / "ur.urdf.xacro", folder, ur_type="ur10e", name="ur")
    origin = arm.origin("joint:elbow_joint")
    upper = way_to(origin, "limit", "upper")
    assert upper[0] == ("property", "elbow_joint_upper_limit")
    assert ("yaml", "joint_limits.elbow_joint.max_position") in upper
    assert upper[-1] == ("arg", "ur_type")
    length = [one for one in behind(origin, attribute(origin, "origin", "xyz")) if one.site]
    assert "kinematics.forearm.x" in {one.name for one in length}
    assert all(one.site in arm.sites for one in origin.inputs if one.site)


def test_a_wheel_of_a_real_robot_leads_through_nested_macros():
    folder = corpus() / "PR2+pr2_common"
    pr2 = TracedRobot(folder / "pr2_description" / "robots" / "pr2.urdf.xacro", folder)
    origin = pr2.origin("link:fl_caster_l_wheel_link")
    assert len(origin.calls) >= 3
    assert all(call.called_at.line and call.defined_at.line for call in origin.calls)
    size = [
        a for a in origin.attributes if a.element.endswith("cylinder") and a.attribute == "radius"
    ]
    assert size
    assert ("property", "wheel_radius") in way_to(origin, size[0].element, "radius")


@pytest.mark.parametrize("name", ["", "a#2", "link:x", "bäse \U0001f980", "a" * 5_000])
def test_a_part_of_any_name_can_be_asked_for(tmp_path: Path, name: str):
    rover = opened(tmp_path, f'<link name="{name}"/><link name="{name}"/>')
    for key in rover.parts:
        assert rover.origin(key).part == key
