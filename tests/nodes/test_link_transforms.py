"""The transforms of a robot's tree: which are told, with which poses, and of which followers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from studio.nodes.link_transforms import LinkTransforms
from studio.robot.kinematics import Kinematics
from studio.robot.urdf_text import robot_from_urdf

ARM = """<robot name="arm">
  <link name="base"/><link name="upper"/><link name="slide"/><link name="tip"/>
  <link name="gear"/><link name="small"/><link name="ball"/><link name="table"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="lift" type="prismatic"><parent link="upper"/><child link="slide"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="slide"/><child link="tip"/>
    <origin xyz="0.1 0 0"/></joint>
  <joint name="follower" type="continuous"><parent link="base"/><child link="gear"/>
    <axis xyz="0 0 1"/><mimic joint="shoulder" multiplier="2" offset="0.5"/></joint>
  <joint name="second" type="continuous"><parent link="gear"/><child link="small"/>
    <axis xyz="0 0 1"/><mimic joint="follower" multiplier="-1"/></joint>
  <joint name="free" type="floating"><parent link="base"/><child link="ball"/></joint>
  <joint name="flat" type="planar"><parent link="base"/><child link="table"/>
    <origin xyz="0 2 0"/></joint>
</robot>"""


def transforms(prefix: str = "") -> LinkTransforms:
    return LinkTransforms(robot_from_urdf(ARM), prefix)


def about_z(angle_rad: float) -> tuple[float, float, float, float]:
    return (math.cos(angle_rad / 2), 0.0, 0.0, math.sin(angle_rad / 2))


def test_fixed_and_planar_joints_are_told_once_and_floating_ones_never():
    told = {one.child: one for one in transforms().fixed()}
    assert sorted(told) == ["table", "tip"]
    assert (told["tip"].parent, told["tip"].xyz_m) == ("slide", (0.1, 0.0, 0.0))
    assert told["table"].xyz_m == (0.0, 2.0, 0.0)


def test_a_joint_moves_its_child_in_its_parent():
    (turned,) = [one for one in transforms().moved({"shoulder": 0.4}) if one.child == "upper"]
    assert turned.parent == "base"
    assert turned.xyz_m == pytest.approx((0, 0, 1))
    assert turned.wxyz == pytest.approx(about_z(math.pi / 2 + 0.4))
    (slid,) = transforms().moved({"lift": 7.0})
    assert slid.xyz_m == pytest.approx((0, 7, 0)), "limits are the controller's business"


def test_followers_move_with_their_leader_through_a_chain():
    told = {one.child: one for one in transforms().moved({"shoulder": 0.4})}
    assert sorted(told) == ["gear", "small", "upper"]
    assert told["gear"].wxyz == pytest.approx(about_z(2 * 0.4 + 0.5))
    assert told["small"].wxyz == pytest.approx((math.cos(0.65), 0, 0, -math.sin(0.65)))


def test_a_follower_that_is_measured_stands_where_it_was_measured():
    told = {one.child: one for one in transforms().moved({"shoulder": 0.4, "follower": 0.1})}
    assert told["gear"].wxyz == pytest.approx(about_z(0.1))
    assert told["small"].wxyz == pytest.approx((math.cos(0.05), 0, 0, -math.sin(0.05)))


def test_only_what_is_known_is_told():
    known = transforms()
    assert known.moved({}) == []
    assert known.moved({"strange": 1.0, "mount": 1.0, "free": 1.0}) == []
    assert known.moved({"lift": math.nan, "shoulder": math.inf}) == []


def test_the_prefix_stands_before_every_frame():
    (slid,) = transforms("r1/").moved({"lift": 0.0})
    assert (slid.parent, slid.child) == ("r1/upper", "r1/slide")
    assert {one.parent for one in transforms("r1/").fixed()} == {"r1/slide", "r1/base"}


def test_down_the_tree_they_come_to_the_pose_of_every_link():
    robot = robot_from_urdf(ARM)
    kinematics = Kinematics(robot)
    positions = {"shoulder": -0.3, "lift": 0.2}
    told = LinkTransforms(robot, kinematics=kinematics)
    parent_from_child = {one.child: one for one in (*told.fixed(), *told.moved(positions))}
    world = kinematics.wxyz_xyz(kinematics.positions_with_mimic(positions))
    slide, tip = (world[kinematics.link_names.index(name)] for name in ("slide", "tip"))
    w, x, y, z = parent_from_child["tip"].wxyz
    assert (x, y, z) == pytest.approx((0, 0, 0)), "then slide and tip have the same axes"
    assert w == pytest.approx(1)
    assert np.linalg.norm(tip[4:] - slide[4:]) == pytest.approx(0.1)
