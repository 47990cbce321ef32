from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from studio.robot.rotations import matrix_from_rpy, wxyz_from_matrices
from studio.scene.link_nodes import wxyz_and_translation, wxyz_from_rpy

ANGLES = st.tuples(*[st.floats(-10, 10)] * 3)


@given(ANGLES)
def test_the_quaternion_turns_as_the_matrix_of_the_robot_room_does(rpy: tuple[float, float, float]):
    ours = np.array(wxyz_from_rpy(rpy))
    theirs = wxyz_from_matrices(matrix_from_rpy(np.array(rpy)))
    assert min(np.abs(ours - theirs).max(), np.abs(ours + theirs).max()) < 1e-9


def test_angles_that_are_no_numbers_count_as_none():
    assert wxyz_from_rpy((float("nan"), float("inf"), 0.0)) == (1.0, 0.0, 0.0, 0.0)


def test_a_matrix_is_taken_apart_into_turn_and_place():
    pose = np.eye(4)
    pose[:3, 3] = (1, 2, 3)
    assert wxyz_and_translation(pose) == ((1.0, 0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
