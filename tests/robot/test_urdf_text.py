"""A URDF text to a robot, as a node takes it: whole, or refused with a reason."""

from __future__ import annotations

import pytest

from studio.errors import RobotError
from studio.robot.urdf_text import robot_from_urdf

TWO_LINKS = """<?xml version="1.0"?>
<robot name="two" xmlns:gazebo="http://gazebo">
  <link name="a"/><link name="b"/>
  <gazebo:plugin/><gazebo reference="a"><x/></gazebo>
  <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
</robot>"""


def test_links_and_joints_are_read_and_all_else_is_passed_over():
    robot = robot_from_urdf(TWO_LINKS)
    assert (robot.name, list(robot.links), list(robot.joints)) == ("two", ["a", "b"], ["j"])


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "not well-formed"),
        ("<robot", "not well-formed"),
        ('<!DOCTYPE r [<!ENTITY e "x">]><robot>&e;</robot>', "declares the entity"),
        ("<launch/>", "begins with <launch>"),
        ("<robot name='r'/>", "no link"),
        ("<robot name='r'><link name='a'/><link name='a'/></robot>", '"a"'),
        ("<robot name='r'><link name='a'/><link name='b'/></robot>", "2 links have no parent"),
        (TWO_LINKS.replace("<parent", "<origin xyz='wobbly'/><parent"), "wobbly"),
        (TWO_LINKS.replace('child link="b"', 'child link="c"'), '"c"'),
    ],
)
def test_what_ros_rejects_is_refused_with_the_reason(text: str, reason: str):
    with pytest.raises(RobotError, match=reason):
        robot_from_urdf(text)
