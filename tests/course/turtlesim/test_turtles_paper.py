from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from studio.course.turtlesim.turtles import FIELD_M, SIZE_PX, Paper, Pen

PLACES = st.tuples(st.floats(0.0, FIELD_M), st.floats(0.0, FIELD_M))
RED = (255, 0, 0)


def test_a_line_has_the_colour_of_its_pen_until_it_is_wiped():
    paper = Paper()
    paper.draw((1.0, 1.0), (3.0, 1.0), Pen(color=RED))
    assert paper.color_at(2.0, 1.0) == RED
    assert paper.color_at(2.0, 2.0) is None
    paper.clear()
    assert paper.color_at(2.0, 1.0) is None


def test_a_lifted_pen_and_one_without_width_draw_nothing():
    paper = Paper()
    paper.draw((1.0, 1.0), (3.0, 1.0), Pen(is_down=False))
    paper.draw((1.0, 1.0), (3.0, 1.0), Pen(width_px=0))
    assert paper.color_at(2.0, 1.0) is None


def test_a_line_is_as_wide_as_its_pen():
    for width in (1, 2, 3, 8):
        paper = Paper()
        paper.draw((2.0, 5.0), (8.0, 5.0), Pen(color=RED, width_px=width))
        column = paper.picture((0, 0, 0))[:, SIZE_PX // 2, 0]
        assert np.count_nonzero(column) == width


def test_y_points_up_in_the_picture():
    paper = Paper()
    paper.draw((0.0, FIELD_M), (0.0, FIELD_M), Pen(color=RED))
    assert tuple(paper.picture((1, 2, 3))[0, 0]) == RED
    assert tuple(paper.picture((1, 2, 3))[-1, -1]) == (1, 2, 3)


@given(PLACES, PLACES, st.integers(1, 255))
def test_both_ends_of_any_line_are_drawn(
    start: tuple[float, float], end: tuple[float, float], width: int
):
    paper = Paper()
    paper.draw(start, end, Pen(color=RED, width_px=width))
    assert paper.color_at(*start) == paper.color_at(*end) == RED
