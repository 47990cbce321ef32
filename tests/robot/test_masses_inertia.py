from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.robot.kinematics import Kinematics
from studio.robot.masses import inertia_box, total
from studio.robot.rotations import matrix_from_rpy
from studio.robot.values import Inertial, Joint, JointType, Link, Origin, Robot, Vector3

sides = st.floats(0.01, 3)
angles = st.floats(-3, 3)


def solid_box(size: Vector3, mass_kg: float = 2.0, rpy: Vector3 = (0, 0, 0)) -> Inertial:
    """The inertia of a box whose axes are turned against those that it is written in."""
    a, b, c = (side * side * mass_kg / 12 for side in size)
    turn = matrix_from_rpy(np.array(rpy))
    tensor = turn @ np.diag([b + c, a + c, a + b]) @ turn.T
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = tensor.tolist()
    return Inertial(Origin((1, 2, 3)), mass_kg, ixx, ixy, ixz, iyy, iyz, izz)


def test_the_box_of_a_box_is_itself():
    box = inertia_box(Link("l", inertial=solid_box((1, 2, 3))))
    assert box is not None
    np.testing.assert_allclose(box.size_m, [1, 2, 3])
    np.testing.assert_allclose(box.link_from_box[:3, 3], [1, 2, 3])
    assert not box.size_m.flags.writeable


@given(st.tuples(sides, sides, sides), st.tuples(angles, angles, angles))
def test_a_turned_box_is_found_by_its_principal_axes(size: Vector3, rpy: Vector3):
    inertial = solid_box(size, rpy=rpy)
    box = inertia_box(Link("l", inertial=inertial))
    assert box is not None
    np.testing.assert_allclose(sorted(box.size_m), sorted(size), rtol=1e-4, atol=1e-4)
    axes = box.link_from_box[:3, :3]
    assert np.linalg.det(axes) == pytest.approx(1)
    a, b, c = box.size_m**2 * inertial.mass_kg / 12
    again = axes @ np.diag([b + c, a + c, a + b]) @ axes.T
    np.testing.assert_allclose(again[0, 1], inertial.ixy, atol=1e-6)


def test_the_axes_of_the_inertial_frame_turn_the_box():
    turned = Inertial(Origin(rpy=(0, 0, math.pi / 2)), 1, ixx=0.1, iyy=0.2, izz=0.25)
    box = inertia_box(Link("l", inertial=turned))
    assert box is not None
    np.testing.assert_allclose(box.link_from_box[:3, 0], [0, 1, 0], atol=1e-12)


@pytest.mark.parametrize("inertial", [None, Inertial(Origin(), 0.0), Inertial(Origin(), -1.0)])
def test_a_link_without_mass_has_no_box(inertial: Inertial | None):
    assert inertia_box(Link("l", inertial=inertial)) is None


@pytest.mark.parametrize(
    "inertial",
    [
        Inertial(Origin(), 1.0),
        Inertial(Origin(), 1.0, -1, 0, 0, 1, 0, 1),
        Inertial(Origin(), 1.0, 1, 0, 0, 1, 0, 2.5),
        Inertial(Origin(), 1.0, 1, 5, 0, 1, 0, 1),
    ],
)
def test_what_no_body_can_have_gets_a_box_of_real_sides(inertial: Inertial):
    box = inertia_box(Link("arm", inertial=inertial))
    assert box is not None
    assert np.isfinite(box.size_m).all()
    assert (box.size_m >= 0).all()


def test_a_rod_is_as_long_as_its_inertia_says():
    rod = Inertial(Origin(), 1.0, ixx=1.0, iyy=1.0, izz=0.0)
    box = inertia_box(Link("l", inertial=rod))
    assert box is not None
    np.testing.assert_allclose(box.size_m, [0, 0, math.sqrt(12)])


def test_the_centre_of_mass_moves_with_the_joints():
    weight = Inertial(Origin((1, 0, 0)), 3.0)
    joint = Joint("j", JointType.CONTINUOUS, "a", "b", axis=(0, 0, 1))
    robot = Robot(
        "r",
        {"a": Link("a", inertial=Inertial(Origin(), 1.0)), "b": Link("b", inertial=weight)},
        {"j": joint},
    )
    whole = total(robot, Kinematics(robot), np.array([math.pi / 2]))
    assert whole.mass_kg == 4
    np.testing.assert_allclose(whole.centre_m, [0, 0.75, 0], atol=1e-12)


def test_a_robot_without_mass_has_no_centre():
    robot = Robot("r", {"a": Link("a")})
    assert np.isnan(total(robot, Kinematics(robot), np.zeros(0)).centre_m).all()
