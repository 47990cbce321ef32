from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from studio.displays.drawing import Lines, Points, Triangles
from studio.displays.markers.kinds import Kind
from tests.support.markers import QUARTER_ABOUT_Z, Rgba, marker, shown

BOTH_ORDERS = pytest.mark.parametrize("little", [True, False], ids=["little", "big"])
RED, GREEN, CLEAR = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 1.0, 0.0)
HALF_BLUE = (0.0, 0.0, 1.0, 0.5)
CORNERS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]


def lines(*markers: Any, little: bool = True) -> Lines:  # noqa: ANN401
    made = shown(*markers, little=little)["lines-0"]
    assert isinstance(made, Lines)
    return made


def dots(*markers: Any, name: str = "points-0", little: bool = True) -> Points:  # noqa: ANN401
    made = shown(*markers, little=little)[name]
    assert isinstance(made, Points)
    return made


def surface(*markers: Any, name: str = "triangles-0", little: bool = True) -> Triangles:  # noqa: ANN401
    made = shown(*markers, little=little)[name]
    assert isinstance(made, Triangles)
    return made


@BOTH_ORDERS
def test_a_line_strip_joins_its_points_and_is_as_thick_as_scale_x(little: bool):
    made = lines(marker(Kind.LINE_STRIP, wxyz=QUARTER_ABOUT_Z, points=CORNERS), little=little)
    placed = [[1, 2, 3], [1, 3, 3], [0, 3, 3], [0, 2, 3]]
    expected = [placed[:2], placed[1:3], placed[2:]]
    assert_allclose(made.ends, expected, atol=1e-6)
    assert made.ends.dtype == np.float32
    assert (made.width_m, made.opacity) == (0.5, 1.0)
    assert made.colors.tolist() == [255, 0, 51]


@BOTH_ORDERS
def test_a_line_list_joins_every_two_points(little: bool):
    colors = [RED, GREEN, GREEN, RED]
    one = marker(Kind.LINE_LIST, at=(0.0, 0.0, 0.0), points=CORNERS, colors=colors)
    made = lines(one, little=little)
    assert_allclose(made.ends, [CORNERS[:2], CORNERS[2:]])
    assert made.colors.tolist() == [[[255, 0, 0], [0, 255, 0]], [[0, 255, 0], [255, 0, 0]]]


def test_strips_and_lists_of_one_thickness_are_one_shape_and_do_not_touch():
    made = lines(
        marker(Kind.LINE_STRIP, 0, at=(0.0, 0.0, 0.0), points=CORNERS[:3]),
        marker(Kind.LINE_LIST, 1, at=(0.0, 0.0, 5.0), points=CORNERS),
        marker(Kind.LINE_STRIP, 2, at=(0.0, 0.0, 9.0), points=CORNERS[:2]),
    )
    assert made.ends[:, :, 2].tolist() == [[0, 0], [0, 0], [5, 5], [5, 5], [9, 9]]


def test_lines_of_other_widths_and_opacities_are_shapes_of_their_own():
    found = shown(
        marker(Kind.LINE_STRIP, 0, points=CORNERS, scale=(0.1, 0.0, 0.0)),
        marker(Kind.LINE_STRIP, 1, points=CORNERS, scale=(0.2, 0.0, 0.0)),
        marker(Kind.LINE_STRIP, 2, points=CORNERS, scale=(0.2, 0.0, 0.0), rgba=HALF_BLUE),
    )
    looks = [
        (each.width_m, round(each.opacity, 2)) for each in found.values() if isinstance(each, Lines)
    ]
    assert looks == [(0.1, 1.0), (0.2, 0.5), (0.2, 1.0)]


@pytest.mark.parametrize(
    "one",
    [
        marker(Kind.LINE_STRIP, points=CORNERS, scale=(0.0, 1.0, 1.0)),
        marker(Kind.LINE_STRIP, points=CORNERS[:1]),
        marker(Kind.LINE_LIST, points=CORNERS[:3]),
        marker(Kind.LINE_STRIP),
        marker(Kind.POINTS),
        marker(Kind.POINTS, points=CORNERS, scale=(0.0, 1.0, 1.0)),
        marker(Kind.POINTS, points=CORNERS, rgba=CLEAR),
        marker(Kind.TRIANGLES, points=CORNERS),
        marker(Kind.TRIANGLES),
    ],
)
def test_what_makes_no_line_point_or_surface_draws_nothing(one: object):
    assert shown(one) == {}


@BOTH_ORDERS
def test_points_are_squares_as_wide_as_scale_x(little: bool):
    one = marker(Kind.POINTS, points=CORNERS[:2], colors=[RED, GREEN], scale=(0.5, 0.5, 0.0))
    made = dots(one, little=little)
    assert (made.style, made.size_m, made.opacity) == ("squares", 0.5, 1.0)
    assert_allclose(made.positions, [[1, 2, 3], [2, 2, 3]])
    assert made.colors.tolist() == [[255, 0, 0], [0, 255, 0]]
    assert not made.precise


def test_points_have_their_own_opacity_and_those_that_are_clear_are_not_drawn():
    colors = [RED, HALF_BLUE, CLEAR, GREEN]
    one = marker(Kind.POINTS, points=CORNERS, colors=colors, rgba=CLEAR)
    assert dots(one).colors.tolist() == [0, 0, 255]
    assert dots(one).opacity == pytest.approx(0.5, abs=0.01)
    assert_allclose(dots(one, name="points-1").positions, [[1, 2, 3], [1, 3, 3]])


def test_ever_so_many_opacities_and_sizes_are_few_shapes():
    many = [
        marker(Kind.POINTS, each, points=[(0.0, 0.0, 0.0)], rgba=(1.0, 0.0, 0.0, each / 255),
               scale=(0.01 * 1.001**each, 1.0, 1.0))
        for each in range(1, 256)
    ]  # fmt: skip
    found = shown(*many)
    assert len(found) <= 60
    shapes = [each for each in found.values() if isinstance(each, Points)]
    assert sum(len(each.positions) for each in shapes) == 255


def test_far_points_that_are_small_are_precise():
    far = dots(marker(Kind.POINTS, points=[(500.0, 0.0, 0.0)], scale=(0.1, 0.1, 0.0)))
    assert far.precise


@BOTH_ORDERS
def test_triangles_are_stretched_turned_and_moved(little: bool):
    one = marker(Kind.TRIANGLES, wxyz=QUARTER_ABOUT_Z, scale=(2.0, 3.0, 1.0), points=CORNERS[:3])
    made = surface(one, little=little)
    assert_allclose(made.vertices, [[1, 2, 3], [1, 4, 3], [-2, 4, 3]], atol=1e-6)
    assert made.faces.tolist() == [[0, 1, 2]]
    assert made.faces.dtype == np.uint32
    assert made.colors.tolist() == [255, 0, 51]


def test_triangles_of_several_markers_are_one_surface():
    three = [marker(Kind.TRIANGLES, each, points=CORNERS[:3]) for each in range(3)]
    assert surface(*three).faces.tolist() == [[0, 1, 2], [3, 4, 5], [6, 7, 8]]


def test_each_vertex_or_each_triangle_has_its_colour():
    points = [*CORNERS[:3], *CORNERS[1:]]
    by_vertex = surface(marker(Kind.TRIANGLES, points=points, colors=[RED, GREEN, RED] * 2))
    assert by_vertex.colors.tolist() == [[255, 0, 0], [0, 255, 0], [255, 0, 0]] * 2
    by_face = surface(marker(Kind.TRIANGLES, points=points, colors=[RED, GREEN]))
    assert by_face.colors.tolist() == [[255, 0, 0]] * 3 + [[0, 255, 0]] * 3


@pytest.mark.parametrize(
    ("colors", "alpha", "opacity"),
    [
        ([RED] * 3, 0.0, 1.0),
        ([RED] * 2 + [HALF_BLUE], 1.0, 2.5 / 3),
        ([HALF_BLUE] * 3, 0.5, 0.25),
        ([HALF_BLUE], 1.0, 1.0),
        ([HALF_BLUE], 0.5, 0.25),
    ],
)
def test_surfaces_with_colours_of_their_own_blend_as_in_rviz(
    colors: list[Rgba], alpha: float, opacity: float
):
    one = marker(Kind.TRIANGLES, points=CORNERS[:3], colors=colors, rgba=(1.0, 1.0, 1.0, alpha))
    assert surface(one).opacity == pytest.approx(opacity, abs=0.01)
