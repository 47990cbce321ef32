from __future__ import annotations

import math
from dataclasses import astuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.robot.comparison import TINY, Row, number_row, pose_rows, text_row, vector_rows
from studio.robot.values import Origin

_ANGLES = st.tuples(*[st.floats(-6, 6)] * 3)


@pytest.mark.parametrize(
    ("one", "other"),
    [(1.0, 1.0 + 1e-7), (0.0, 1e-10), (math.nan, math.nan), (math.inf, math.inf)],
)
def test_rounding_is_no_difference(one: float, other: float):
    assert list(number_row("mass", one, other, "kg")) == []


@pytest.mark.parametrize(("one", "other"), [(1.0, 1.001), (0.0, 1e-8), (1.0, math.nan)])
def test_other_numbers_are_one(one: float, other: float):
    (row,) = number_row("mass", one, other, "kg")
    assert astuple(row) == astuple(Row("mass", one, other, "kg"))  # rows of NaN are never equal


def test_the_inertia_of_a_screw_is_no_rounding():
    assert list(number_row("ixx", 1e-12, 2e-12, "kg m^2", TINY))


def test_a_number_that_only_one_has_is_a_row():
    assert list(number_row("mass", None, 2.0, "kg")) == [Row("mass", None, 2.0, "kg")]
    assert list(number_row("mass", None, None, "kg")) == []


def test_only_the_axes_that_differ_are_rows():
    rows = list(vector_rows("size", (1, 2, 3), (1, 2.5, 3), "m"))
    assert rows == [Row("size.y", 2, 2.5, "m")]


def test_texts_differ_or_not():
    assert list(text_row("type", "fixed", "fixed")) == []
    assert list(text_row("type", "fixed", None)) == [Row("type", "fixed", None)]


def test_half_a_turn_to_either_side_is_one_rotation():
    assert (
        list(pose_rows("origin", Origin(rpy=(math.pi, 0, 0)), Origin(rpy=(-math.pi, 0, 0)))) == []
    )
    other = Origin(rpy=(math.pi, 0, 0.1))
    (row,) = pose_rows("origin", Origin(rpy=(math.pi, 0, 0)), other)
    assert row == Row("origin.yaw", 0, 0.1, "rad")


@given(_ANGLES, st.tuples(*[st.sampled_from([-1, 0, 1])] * 3))
def test_whole_turns_are_no_difference(rpy: tuple[float, ...], turns: tuple[int, ...]):
    roll, pitch, yaw = (angle + 2 * math.pi * n for angle, n in zip(rpy, turns, strict=True))
    one = Origin(rpy=(rpy[0], rpy[1], rpy[2]))
    assert list(pose_rows("origin", one, Origin(rpy=(roll, pitch, yaw)))) == []


def test_angles_that_are_no_numbers_are_compared_one_by_one():
    broken = Origin(rpy=(math.inf, 0, 0))
    assert [row.what for row in pose_rows("origin", Origin(), broken)] == ["origin.roll"]
