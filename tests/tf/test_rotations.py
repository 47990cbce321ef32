from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from studio.tf.rotations import (
    IDENTITY,
    Pose,
    between,
    between_two,
    compose,
    inverse,
    inverse_of,
    matrices_from_poses,
    poses_from_matrices,
)
from tests.support.transforms import Vector, about_z, slerp

TURNS = (
    st.tuples(*[st.floats(-1, 1)] * 4)
    .filter(lambda turn: math.hypot(*turn) > 0.1)
    .map(lambda turn: tuple(part / math.hypot(*turn) for part in turn))
)


def pose_of(turn: Vector, place: tuple[float, float, float]) -> Pose:
    w, x, y, z = turn
    return (w, x, y, z, *place)


POSES = st.builds(pose_of, TURNS, st.tuples(*[st.floats(-100, 100)] * 3))


def row(pose: Vector) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return np.array([pose])


@given(POSES, POSES)
def test_poses_and_matrices_are_composed_and_inverted_alike(first: Pose, second: Pose):
    a_from_b, b_from_c = matrices_from_poses(np.array([first, second]))
    composed = matrices_from_poses(row(compose(first, second)))[0]
    assert composed == pytest.approx(a_from_b @ b_from_c, abs=1e-11)
    b_from_a = matrices_from_poses(row(inverse(first)))[0]
    assert b_from_a @ a_from_b == pytest.approx(np.eye(4), abs=1e-11)
    assert inverse_of(a_from_b) @ a_from_b == pytest.approx(np.eye(4), abs=1e-12)


@given(POSES)
def test_a_matrix_gives_its_pose_back(pose: Pose):
    (back,) = poses_from_matrices(matrices_from_poses(row(pose)))
    sign = math.copysign(1.0, float(np.dot(back[:4], pose[:4])))
    assert back[:4] * sign == pytest.approx(np.array(pose[:4]), abs=1e-12)
    assert back[4:].tolist() == list(pose[4:])


@pytest.mark.parametrize("axis", range(4))
def test_half_turns_have_exact_quaternions(axis: int):
    pose = np.zeros((1, 7))
    pose[0, axis] = 1.0
    assert poses_from_matrices(matrices_from_poses(pose)).tolist() == pose.tolist()


@given(TURNS, TURNS, st.floats(0, 1))
def test_turns_between_lie_on_the_shorter_arc(first: Vector, second: Vector, share: float):
    assume(abs(np.dot(first, second)) > 1e-6)
    (mixed,) = between(
        row((*first, 0.0, 0.0, 0.0)), row((*second, 2.0, 0.0, 0.0)), np.array([share])
    )
    expected = slerp(first, second, share)
    alone = between_two(pose_of(first, (0.0, 0.0, 0.0)), pose_of(second, (2.0, 0.0, 0.0)), share)
    assert alone == pytest.approx(mixed, abs=1e-12)
    sign = math.copysign(1.0, float(np.dot(mixed[:4], expected)))
    assert mixed[:4] * sign == pytest.approx(np.array(expected), abs=1e-12)
    assert mixed[4] == pytest.approx(2.0 * share, abs=1e-15)


@pytest.mark.parametrize("angle_rad", [0.0, 1e-12, 1e-9, 1e-8, 1e-6, 1e-3])
def test_small_turns_lose_nothing(angle_rad: float):
    half = about_z(angle_rad / 2)
    first, second = row((*about_z(0.0), 0.0, 0.0, 0.0)), row((*about_z(angle_rad), 0.0, 0.0, 0.0))
    (mixed,) = between(first, second, np.array([0.5]))
    assert mixed[3] == pytest.approx(half[3], rel=1e-12, abs=0)
    zero: Pose = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    alone = between_two(zero, pose_of(about_z(angle_rad), (0.0, 0.0, 0.0)), 0.5)
    assert alone[3] == pytest.approx(half[3], rel=1e-12, abs=0)


def test_nothing_is_where_it_is():
    assert compose(IDENTITY, IDENTITY) == IDENTITY
    assert matrices_from_poses(np.zeros((0, 7))).shape == (0, 4, 4)
    assert poses_from_matrices(np.zeros((0, 4, 4))).shape == (0, 7)
