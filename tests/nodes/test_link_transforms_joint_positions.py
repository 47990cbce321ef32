"""Joint positions read out of transforms: what LinkTransforms wrote comes back."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.nodes.link_transforms import JointReading, LinkTransform, LinkTransforms
from studio.robot.kinematics import Kinematics
from studio.robot.urdf_text import robot_from_urdf

ROBOT = robot_from_urdf("""<robot name="r">
  <link name="base"/><link name="wheel"/><link name="lift"/><link name="arm"/>
  <joint name="spin" type="continuous"><parent link="base"/><child link="wheel"/>
    <origin xyz="1 2 3" rpy="0.3 -1.2 2.5"/><axis xyz="1 2 -0.5"/></joint>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="lift"/>
    <origin xyz="1 0 0" rpy="1 1 1"/><axis xyz="0 1 1"/>
    <limit lower="-5" upper="5" effort="1" velocity="1"/></joint>
  <joint name="turns" type="revolute"><parent link="lift"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="6" effort="1" velocity="1"/></joint>
</robot>""")
KINEMATICS = Kinematics(ROBOT)
READING = JointReading(ROBOT, KINEMATICS)
WRITING = LinkTransforms(ROBOT, kinematics=KINEMATICS)


@given(
    spin=st.floats(-math.pi + 1e-6, math.pi - 1e-6),
    lift=st.floats(-5, 5),
    turns=st.floats(0, 6),
)
def test_what_was_written_is_read_again(spin: float, lift: float, turns: float):
    positions = {"spin": spin, "lift": lift, "turns": turns}
    assert READING.positions(WRITING.moved(positions)) == pytest.approx(positions, abs=1e-7)


def test_transforms_of_others_are_passed_over():
    strange = LinkTransform("map", "wheel", (0, 0, 0), (1, 0, 0, 0))
    unknown = LinkTransform("base", "nobody", (0, 0, 0), (1, 0, 0, 0))
    assert READING.positions([strange, unknown]) == {}


def test_what_is_no_number_or_no_rotation_moves_nothing():
    no_number = LinkTransform("base", "lift", (math.nan, 0, 0), (1, 0, 0, 0))
    no_rotation = LinkTransform("lift", "arm", (0, 0, 0), (0, 0, 0, 0))
    no_turn = LinkTransform("lift", "arm", (0, 0, 0), (math.inf, 0, 0, math.nan))
    assert READING.positions([no_number, no_rotation, no_turn]) == {}


def test_of_robots_with_prefixes_the_first_is_read_until_one_without_comes():
    reading = JointReading(ROBOT, KINEMATICS)

    def told(prefix: str, lift: float) -> dict[str, float]:
        writing = LinkTransforms(ROBOT, prefix, KINEMATICS)
        return reading.positions(writing.moved({"lift": lift}))

    assert told("r1/", 1.0) == pytest.approx({"lift": 1.0})
    assert told("r2/", 2.0) == {}
    assert told("r1/", 1.5) == pytest.approx({"lift": 1.5})
    assert told("", 3.0) == pytest.approx({"lift": 3.0})
    assert told("r1/", 1.0) == {}


def test_two_links_of_different_prefixes_are_those_of_no_robot():
    reading = JointReading(ROBOT, KINEMATICS)
    mixed = LinkTransform("r1/base", "r2/lift", (1, 0, 0), (1, 0, 0, 0))
    assert reading.positions([mixed]) == {}
