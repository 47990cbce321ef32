from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from studio.robot.kinematics import floating_motion
from studio.robot.rotations import (
    cross_matrices,
    matrix_from_rpy,
    unit_vectors,
    wxyz_from_matrices,
)

angles = st.floats(-math.pi, math.pi)
components = st.floats(-1, 1)


@given(angles, angles, angles)
def test_roll_pitch_yaw_is_the_product_of_three_turns(roll: float, pitch: float, yaw: float):
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    product = about_z @ about_y @ about_x
    np.testing.assert_allclose(matrix_from_rpy(np.array([roll, pitch, yaw])), product, atol=1e-12)


@given(st.tuples(components, components, components, components))
def test_a_quaternion_comes_back_from_its_matrix(wxyz: tuple[float, float, float, float]):
    quaternion = np.array(wxyz)
    length = float(np.linalg.norm(quaternion))
    if length < 1e-3:
        return
    back = wxyz_from_matrices(floating_motion(np.zeros(3), quaternion)[:3, :3])
    assert back[0] >= 0
    assert abs(abs(float(back @ quaternion)) / length - 1) < 1e-9


def test_half_turns_have_quaternions_too():
    turns = np.array([np.diag([1.0, -1, -1]), np.diag([-1.0, 1, -1]), np.diag([-1.0, -1, 1])])
    assert wxyz_from_matrices(turns).tolist() == [[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


@given(st.tuples(components, components, components), st.tuples(components, components, components))
def test_a_cross_matrix_multiplies_as_the_cross_product(
    a: tuple[float, float, float], b: tuple[float, float, float]
):
    product = cross_matrices(np.array(a)) @ np.array(b)
    np.testing.assert_allclose(product, np.cross(a, b), atol=1e-12)


def test_unit_vectors_leave_zero_as_it_is():
    np.testing.assert_array_equal(
        unit_vectors(np.array([[0.0, 0, 0], [0, 3, 4]])), [[0, 0, 0], [0, 0.6, 0.8]]
    )
