from __future__ import annotations

import math

import pytest

from studio.errors import RobotError
from studio.robot.elements import ParsedElement, read_element
from studio.robot.values import (
    Box,
    Cylinder,
    Joint,
    JointType,
    Limit,
    Link,
    Material,
    Mesh,
    Mimic,
    Origin,
    Sphere,
)
from tests.support.expanded import element_of

LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'
ENDS = '<parent link="a"/><child link="b"/>'


def parse_element(xml: str) -> ParsedElement:
    """Read an element from text; text that is refused is its fault."""
    try:
        return read_element(element_of(xml))
    except RobotError as error:
        return ParsedElement(faults=[error])


def link(inner: str) -> Link:
    parsed = parse_element(f'<link name="l">{inner}</link>')
    assert not parsed.faults
    assert isinstance(parsed.value, Link)
    return parsed.value


def joint(inner: str, kind: str = "fixed") -> Joint:
    parsed = parse_element(f'<joint name="j" type="{kind}">{ENDS}{inner}</joint>')
    assert not parsed.faults
    assert isinstance(parsed.value, Joint)
    return parsed.value


def faults(xml: str) -> list[str]:
    return [str(one) for one in parse_element(xml).faults]


def test_a_link_without_anything_is_only_a_name():
    assert link("") == Link("l")


@pytest.mark.parametrize(
    ("shape", "geometry"),
    [
        ('<box size="1 2 3"/>', Box((1, 2, 3))),
        ('<cylinder radius="0.5" length="2"/>', Cylinder(0.5, 2)),
        ('<sphere radius="1e-1"/>', Sphere(0.1)),
        ('<mesh filename="package://p/a.stl"/>', Mesh("package://p/a.stl")),
        ('<mesh filename=" a.dae " scale=".001 .001 .001"/>', Mesh("a.dae", (0.001, 0.001, 0.001))),
    ],
)
def test_each_shape_is_read_in_visuals_and_collisions(shape: str, geometry: object):
    inner = f"<geometry>{shape}</geometry>"
    read = link(f"<visual>{inner}</visual><collision>{inner}</collision>")
    assert read.visuals[0].geometry == read.collisions[0].geometry == geometry
    assert read.visuals[0].origin == Origin()


def test_several_visuals_keep_their_order_names_and_origins():
    shape = '<geometry><sphere radius="1"/></geometry>'
    read = link(f'<visual name="x"><origin rpy="0 0 1"/>{shape}</visual><visual>{shape}</visual>')
    assert [one.name for one in read.visuals] == ["x", ""]
    assert read.visuals[0].origin == Origin((0, 0, 0), (0, 0, 1))


def test_inertia_entries_that_are_missing_are_zero():
    read = link('<inertial><mass value="2"/><inertia ixx="1" iyz="0.5"/></inertial>')
    assert read.inertial is not None
    assert (read.inertial.mass_kg, read.inertial.ixx, read.inertial.iyz) == (2, 1, 0.5)
    assert read.inertial.izz == 0


def test_a_joint_without_axis_turns_about_x():
    assert joint("", "continuous").axis == (1, 0, 0)


@pytest.mark.parametrize("kind", list(JointType))
def test_each_joint_type_is_read(kind: JointType):
    read = joint(LIMIT, kind)
    assert read.type is kind
    assert read.limit == Limit(-1, 2, 3, 4)


def test_a_mimic_takes_the_defaults_of_ros():
    assert joint('<mimic joint="x"/>').mimic == Mimic("x", 1.0, 0.0)
    assert joint('<mimic joint="x" multiplier="-2" offset="1"/>').mimic == Mimic("x", -2, 1)


def test_a_material_has_a_colour_a_texture_or_only_a_name():
    read = parse_element(
        '<material name="m"><color rgba="1 0 0 2"/><texture filename="t.png"/></material>'
    )
    assert read.value == Material("m", (1, 0, 0, 1), "t.png")
    assert parse_element('<material name="m"/>').value == Material("m")


def test_other_elements_are_nothing():
    assert parse_element('<gazebo reference="x"><a:b/></gazebo>').value is None


def test_a_prefix_that_nobody_declared_does_not_matter():
    assert link('<drake:tag a:b="1"/>') == Link("l")


@pytest.mark.parametrize(
    ("xml", "said"),
    [
        (
            '<link name="arm"><visual><geometry><box size="0.07, 1 1"/></geometry></visual></link>',
            'link "arm", visual 1: size of <box> is "0.07, 1 1": write numbers.',
        ),
        (
            '<link name="arm"><inertial><mass value="nan"/></inertial></link>',
            'link "arm", inertial: value of <mass> is "nan": write finite numbers.',
        ),
        (
            f'<joint name="j" type="fixed">{ENDS}<limit upper="1_000"/></joint>',
            'joint "j": upper of <limit> is "1_000": write numbers.',
        ),
        (
            f'<joint name="j" type="fixed">{ENDS}<origin xyz="0 0 ٣"/></joint>',
            'joint "j": xyz of <origin> is "0 0 ٣": write numbers.',
        ),
        (
            '<link name="arm"><inertial/></link>',
            'link "arm", inertial has no <mass>: write one.',
        ),
        (
            '<link name="arm"><collision><geometry><capsule/></geometry></collision></link>',
            'link "arm", collision 1: its geometry holds <capsule>: '
            "URDF knows box, cylinder, sphere and mesh.",
        ),
        (
            f'<joint name="j" type="fixed">{ENDS}<origin xyz="0 0"/></joint>',
            'joint "j": xyz of <origin> is "0 0": write three numbers separated by blanks.',
        ),
        (
            f'<joint name="j" type="fixed">{ENDS}<limit upper="-1.57."/></joint>',
            'joint "j": upper of <limit> is "-1.57.": write numbers.',
        ),
        (
            '<joint name="j" type="fixed"><parent link="a"/></joint>',
            'joint "j" has no <child>: write one.',
        ),
        ("<link/>", "A <link> has no name and was left out: give it one."),
        (
            '<material name="m"><color rgba="1 0"/></material>',
            'material "m": rgba of <color> is "1 0": write four numbers from 0 to 1.',
        ),
    ],
)
def test_a_mistake_says_where_it_is_and_what_was_written(xml: str, said: str):
    assert faults(xml) == [said]


def test_a_broken_visual_leaves_the_others():
    good = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    bad = '<visual><geometry><sphere radius="x"/></geometry></visual>'
    parsed = parse_element(f'<link name="l">{good}{bad}{good}</link>')
    assert isinstance(parsed.value, Link)
    assert len(parsed.value.visuals) == 2
    assert len(parsed.faults) == 1


def test_a_broken_origin_leaves_the_joint():
    parsed = parse_element(f'<joint name="j" type="fixed">{ENDS}<origin xyz="a b c"/></joint>')
    assert parsed.value == Joint("j", JointType.FIXED, "a", "b")


def test_a_joint_of_unknown_type_is_drawn_fixed():
    parsed = parse_element(f'<joint name="j" type="ball">{ENDS}</joint>')
    assert isinstance(parsed.value, Joint)
    assert parsed.value.type is JointType.FIXED
    assert not parsed.faults


def test_entities_are_refused():
    xml = '<!DOCTYPE link [<!ENTITY e SYSTEM "file:///etc/passwd">]><link name="&e;"/>'
    assert parse_element(xml).value is None
    assert 'entity "e"' in faults(xml)[0]


def test_broken_xml_is_a_fault():
    assert "not well-formed" in faults("<link name='a'><visual></link>")[0]


def test_a_long_mistake_is_cut_in_the_sentence():
    assert (
        len(faults(f'<link name="a"><inertial><mass value="{"x" * 999}"/></inertial></link>')[0])
        < 150
    )


def test_a_limit_may_be_of_any_size_and_a_very_large_one_bounds_nothing():
    text = '<limit lower="-1e+16" upper="1e16" effort="1e300" velocity="1e15"/>'
    parsed = parse_element(f'<joint name="j" type="revolute">{ENDS}{text}</joint>')
    assert not parsed.faults
    assert isinstance(parsed.value, Joint)
    assert parsed.value.limit == Limit(-1e16, 1e16, 1e300, 1e15)
    assert Limit(-1e16, 1e16).bounds == (-math.inf, math.inf)
    assert Limit(-1.5, 1e16).bounds == (-1.5, math.inf)


@pytest.mark.parametrize("written", ["inf", "nan", "-inf", "1e999", "1 2", "a"])
def test_a_limit_that_is_no_number_is_left_out(written: str):
    text = f'<limit lower="{written}" upper="1" effort="1" velocity="1"/>'
    parsed = parse_element(f'<joint name="j" type="revolute">{ENDS}{text}</joint>')
    assert [str(fault).partition(":")[0] for fault in parsed.faults] == ['joint "j"']
