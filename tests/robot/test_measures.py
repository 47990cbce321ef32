from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.robot.comparison import whole_rows
from studio.robot.kinematics import Kinematics
from studio.robot.measures import Measures, box_around, measure, reach_m
from studio.robot.values import (
    Box,
    Inertial,
    Joint,
    JointType,
    Limit,
    Link,
    Mesh,
    Origin,
    Robot,
    Visual,
)

if TYPE_CHECKING:
    from studio.robot.measures import Bounds

BLOCK = Link("base", (Visual(Origin((0, 0, 0.5)), Box((2, 1, 1))),), (), Inertial(Origin(), 3.0))
BAR = Link(
    "bar", (Visual(Origin((1, 0, 0)), Mesh("bar.stl", (1, 2, 1))),), (), Inertial(Origin(), 0.5)
)
TURN = Joint("turn", JointType.REVOLUTE, "base", "bar", Origin((0, 0, 1)), (0, 0, 1), Limit(-9, 9))


def robot(*joints: Joint) -> Robot:
    return Robot("r", {"base": BLOCK, "bar": BAR}, {one.name: one for one in joints or (TURN,)})


def bar(_uri: str) -> Bounds:
    return (-1, -0.1, -0.1), (1, 0.1, 0.1)


def box(made: Robot, angle_rad: float = 0.0) -> Bounds | None:
    return box_around(made, Kinematics(made), np.array([angle_rad]), bar)


def test_the_box_is_around_all_visuals_in_the_pose():
    assert box(robot()) == ((-1, -0.5, 0), (2, 0.5, 1.1))
    turned = box(robot(), math.pi / 2)
    assert turned is not None
    assert np.allclose(turned, ((-1, -0.5, 0), (1, 2, 1.1)))


def test_the_size_is_not_known_while_a_mesh_is_not():
    made = robot()
    assert box_around(made, Kinematics(made), np.zeros(1), lambda _: None) is None


def test_a_robot_without_visuals_has_no_size():
    bare = Robot("bare", {"base": Link("base")})
    assert box_around(bare, Kinematics(bare), np.zeros(0), bar) is None


def test_numbers_that_are_none_give_no_size_and_no_reach():
    far = robot(replace(TURN, origin=Origin((math.inf, 0, 0))))
    with np.errstate(invalid="ignore"):
        assert box(far) is None
    assert reach_m(far) == 0.0


def test_the_reach_is_the_longest_chain_with_its_slides_drawn_out():
    slide = Joint("out", JointType.PRISMATIC, "bar", "tip", Origin((0.5, 0, 0)), limit=Limit(0, 2))
    links = {"base": BLOCK, "bar": BAR, "tip": Link("tip"), "side": Link("side")}
    short = Joint("short", JointType.FIXED, "base", "side", Origin((0.1, 0, 0)))
    joints = {one.name: one for one in (slide, short, TURN)}
    assert reach_m(Robot("r", links, joints)) == pytest.approx(1 + 0.5 + 2)


def test_whole_robots_differ_in_mass_reach_size_and_counts():
    one = robot()
    measured = measure(one, Kinematics(one), np.zeros(1), bar)
    assert (measured.mass_kg, measured.reach_m, measured.links) == (3.5, 1.0, 2)
    higher = robot(replace(TURN, origin=Origin((0, 0, 2))))
    other = measure(higher, Kinematics(higher), np.zeros(1), bar)
    assert [row.what for row in whole_rows(measured, other)] == ["reach", "size.z"]
    lighter = replace(other, mass_kg=1.0, joints=0, name="s", box=None)
    told_of = [row.what for row in whole_rows(measured, lighter)]
    assert told_of == ["name", "joints", "total_mass", "reach"]


def test_masses_that_are_no_numbers_count_for_nothing():
    odd = Robot("r", {"a": Link("a", inertial=Inertial(Origin(), math.nan))})
    assert measure(odd, Kinematics(odd), np.zeros(0), bar) == Measures("r", 1, 0, 0.0, 0.0, None)
