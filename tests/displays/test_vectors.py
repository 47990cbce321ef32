from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.displays.drawing import Arrows, Lines, Shape
from studio.displays.vectors import Names, Vectors, too_short, vector_properties, vector_shapes

NAMES = Names("Force", "Torque")
VALUES: dict[str, Any] = {one.name: one.default for one in vector_properties(NAMES)}
NOTHING = np.zeros(3)


def vectors(straight: tuple[float, ...], turning: tuple[float, ...]) -> Vectors:
    return Vectors(np.array(straight), np.array(turning))


def drawn(one: Vectors, **values: Any) -> dict[str, Shape]:  # noqa: ANN401
    given = {name.replace("_", " "): value for name, value in values.items()}
    return vector_shapes(one, NAMES, VALUES | given)


def test_the_circle_about_a_turn_goes_round_its_arrow_the_right_way():
    shapes = drawn(vectors((0, 0, 0), (0, 0, 4)))
    circle, head = shapes["around"], shapes["around head"]
    assert isinstance(circle, Lines)
    assert isinstance(head, Arrows)
    # The arrow is 8 m long by RViz's scale of 2: the circle is halfway up, a quarter as wide.
    np.testing.assert_allclose(circle.ends[:, :, 2], 4.0, atol=1e-5)
    np.testing.assert_allclose(np.linalg.norm(circle.ends[:, :, :2], axis=2), 2.0, rtol=1e-5)
    np.testing.assert_array_equal(circle.ends[1:, 0], circle.ends[:-1, 1])
    before, after = circle.ends[:, 0].astype(np.float64), circle.ends[:, 1].astype(np.float64)
    assert (np.cross(before, after)[:, 2] > 0).all()
    np.testing.assert_allclose(head.ends, [[[2.0, 0.0, 4.0], [2.0, 0.05, 4.0]]], atol=1e-5)


@given(st.tuples(*[st.floats(-1e12, 1e12)] * 3), st.floats(0.0, 10.0))
def test_any_turn_draws_a_circle_across_its_arrow(turning: tuple[float, ...], width_m: float):
    shapes = drawn(vectors((0, 0, 0), turning), Arrow_Width=width_m)
    if not shapes:
        return
    arrow, circle = shapes["turning"], shapes["around"]
    assert isinstance(arrow, Arrows)
    assert isinstance(circle, Lines)
    tip = arrow.ends[0, 1].astype(np.float64)
    if np.linalg.norm(tip) < 1e-30:  # float32 has no digits left for what no eye sees
        return
    across = np.diff(circle.ends.astype(np.float64), axis=1)[:, 0]
    size = np.linalg.norm(tip) * np.linalg.norm(across, axis=1)
    assert (np.abs(across @ tip) <= 1e-3 * size).all()


@pytest.mark.parametrize(
    ("straight", "turning", "left"),
    [
        ((1, 0, 0), (0, 0, 0), {"straight"}),
        ((0, 0, 0), (0, 1, 0), {"turning", "around", "around head"}),
        ((0.2, 0, 0), (0, 1, 0), {"turning", "around", "around head"}),
        ((0.2, 0, 0), (0, 0.2, 0), set[str]()),
    ],
)
def test_arrows_shorter_than_wide_are_not_drawn(
    straight: tuple[float, ...], turning: tuple[float, ...], left: set[str]
):
    assert set(drawn(vectors(straight, turning))) == left


def test_why_nothing_is_seen_is_told_with_a_width_that_shows_it():
    one = vectors((0.2, 0, 0), (0, 0.02, 0))
    short = too_short(one, NAMES, VALUES)
    assert short is not None
    sentence, (name, value) = short
    assert "0.4 m long" in sentence
    assert "Arrow Width (0.5 m)" in sentence
    assert "straight" in vector_shapes(one, NAMES, VALUES | {name: value})


def test_nothing_is_told_when_there_is_nothing_to_see_or_something_is_seen():
    assert too_short(vectors((0, 0, 0), (0, 0, 0)), NAMES, VALUES) is None
    assert too_short(vectors((5, 0, 0), (0, 0.01, 0)), NAMES, VALUES) is None


def test_an_arrow_of_no_width_has_no_head_on_its_circle():
    assert "around head" not in drawn(vectors((0, 0, 0), (0, 0, 1)), Arrow_Width=0.0)
