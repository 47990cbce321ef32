from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.displays.turning import (
    FAR,
    Floats,
    angle_between_rad,
    drawable,
    product,
    shortest_turn,
    turned,
    unit_quaternions,
)

PARTS = st.floats(-10, 10)
QUATERNIONS = st.tuples(PARTS, PARTS, PARTS, PARTS).filter(lambda q: math.hypot(*q) > 1e-3)
VECTORS = st.tuples(PARTS, PARTS, PARTS)


def unit(parts: tuple[float, ...]) -> Floats:
    return np.array(parts) / math.hypot(*parts)


def matrix(wxyz: Floats) -> Floats:
    w, x, y, z = wxyz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@given(QUATERNIONS, VECTORS)
def test_a_vector_turns_as_its_matrix_turns_it(parts: tuple[float, ...], vector: tuple[float, ...]):
    wxyz = unit(parts)
    np.testing.assert_allclose(
        turned(wxyz[None], np.array(vector))[0], matrix(wxyz) @ vector, atol=1e-12
    )


@given(QUATERNIONS, QUATERNIONS)
def test_a_product_turns_as_its_parts_one_after_the_other(
    one: tuple[float, ...], other: tuple[float, ...]
):
    both = product(unit(one), unit(other))
    np.testing.assert_allclose(matrix(both), matrix(unit(one)) @ matrix(unit(other)), atol=1e-12)


@given(VECTORS, VECTORS)
def test_the_shortest_turn_brings_one_direction_to_another(
    start: tuple[float, ...], end: tuple[float, ...]
):
    if math.hypot(*start) < 1e-3 or math.hypot(*end) < 1e-3:
        return
    turn = shortest_turn(unit(start), unit(end))
    np.testing.assert_allclose(turned(turn[None], unit(start))[0], unit(end), atol=1e-5)


@pytest.mark.parametrize("axis", np.eye(3))
def test_opposite_directions_are_half_a_turn_apart(axis: Floats):
    turn = shortest_turn(axis, -axis)
    assert np.linalg.norm(turn) == pytest.approx(1.0)
    np.testing.assert_allclose(turned(turn[None], axis)[0], -axis, atol=1e-12)


@pytest.mark.parametrize("size", [5e-324, 1e-300, 1.0, 1e154, 1.7e308])
def test_a_quaternion_of_any_size_gets_length_one(size: float):
    wxyz, zero = unit_quaternions(np.array([[size, size, 0.0, 0.0]]))
    assert not zero.any()
    np.testing.assert_allclose(wxyz, [[math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0]])


def test_a_quaternion_of_zeros_is_no_turn_and_is_told():
    wxyz, zero = unit_quaternions(np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]]))
    assert wxyz.tolist() == [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
    assert zero.tolist() == [True, False]


def test_no_quaternions_are_none():
    wxyz, zero = unit_quaternions(np.empty((0, 4)))
    assert wxyz.shape == (0, 4)
    assert zero.shape == (0,)


def test_a_row_is_drawn_when_all_its_numbers_can_be():
    rows = np.array(
        [[1.0, 2.0], [FAR, -FAR], [np.nan, 0.0], [0.0, np.inf], [-np.inf, 0.0], [1e308, 0.0]]
    )
    assert drawable(rows).tolist() == [True, True, False, False, False, False]


def test_the_angle_between_attitudes_is_the_same_for_both_signs_of_a_quaternion():
    quarter = np.array([math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)])
    none = np.array([1.0, 0.0, 0.0, 0.0])
    assert angle_between_rad(none, quarter) == pytest.approx(math.pi / 2)
    assert angle_between_rad(none, -quarter) == pytest.approx(math.pi / 2)
    assert angle_between_rad(quarter, quarter) == pytest.approx(0.0, abs=1e-7)
