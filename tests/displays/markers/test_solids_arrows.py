from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from studio.displays.drawing import Solids
from studio.displays.markers.kinds import Kind
from studio.displays.turning import turned
from tests.support.markers import QUARTER_ABOUT_Z, marker, shown

BOTH_ORDERS = pytest.mark.parametrize("little", [True, False], ids=["little", "big"])


def parts(*markers: Any, little: bool = True) -> tuple[Solids, Solids]:  # noqa: ANN401
    found = shown(*markers, little=little)
    shafts, heads = found["shafts"], found["heads"]
    assert isinstance(shafts, Solids)
    assert isinstance(heads, Solids)
    assert (shafts.kind, heads.kind) == ("cylinder", "cone")
    return shafts, heads


def ends(solid: Solids, begin: float, end: float) -> tuple[Any, Any]:
    """Where the axis of solids begins and ends, as parts of their height along z."""
    reach = np.zeros((2, len(solid.positions), 3))
    reach[:, :, 2] = np.outer([begin, end], solid.scales[:, 2])
    wxyz = solid.wxyz.astype(np.float64)
    return tuple(solid.positions + turned(wxyz, each) for each in reach)  # pyright: ignore[reportReturnType]


@BOTH_ORDERS
def test_an_arrow_by_its_pose_lies_along_x_as_long_as_scale_x(little: bool):
    shafts, heads = parts(
        marker(Kind.ARROW, wxyz=QUARTER_ABOUT_Z, scale=(2.0, 0.1, 0.3)), little=little
    )
    tail, neck = ends(shafts, -0.5, 0.5)
    tip, base = ends(heads, 0, 1)
    assert_allclose(tail, [[1, 2, 3]], atol=1e-6)
    assert_allclose(neck, [[1, 3.54, 3]], atol=1e-6)
    assert_allclose(base, neck, atol=1e-6)
    assert_allclose(tip, [[1, 4, 3]], atol=1e-6)


def test_an_arrow_by_its_pose_is_as_wide_as_scale_y_and_as_high_as_scale_z():
    shafts, heads = parts(marker(Kind.ARROW, scale=(2.0, 0.1, 0.3)))
    for solid, factor in ((shafts, 1), (heads, 2)):
        wxyz = solid.wxyz.astype(np.float64)
        across_x, across_y = (turned(wxyz, axis)[0] for axis in np.eye(3)[:2])
        assert_allclose(np.abs(across_x), [0, 0, 1], atol=1e-6)
        assert_allclose(np.abs(across_y), [0, 1, 0], atol=1e-6)
        assert_allclose(solid.scales[0, :2], [0.3 * factor, 0.1 * factor], rtol=1e-6)


def test_an_arrow_of_negative_length_points_backwards():
    shafts, heads = parts(marker(Kind.ARROW, scale=(-2.0, 0.1, 0.3)))
    assert_allclose(ends(shafts, -0.5, 0.5)[0], [[1, 2, 3]], atol=1e-6)
    assert_allclose(ends(heads, 0, 1)[0], [[-1, 2, 3]], atol=1e-6)
    assert (shafts.scales > 0).all()


@BOTH_ORDERS
@pytest.mark.parametrize(("head_length", "expected"), [(0.5, 0.5), (0.0, 0.23 * 4)])
def test_an_arrow_by_two_points_has_the_diameters_and_the_head_that_scale_says(
    head_length: float, expected: float, little: bool
):
    points = [(1.0, 0.0, 0.0), (1.0, 0.0, -4.0)]
    one = marker(Kind.ARROW, points=points, scale=(0.1, 0.2, head_length))
    shafts, heads = parts(one, little=little)
    assert_allclose(heads.scales, [[0.2, 0.2, expected]], rtol=1e-6)
    assert_allclose(shafts.scales, [[0.1, 0.1, 4 - expected]], rtol=1e-6)
    assert_allclose(ends(shafts, -0.5, 0.5)[0], [[2, 2, 3]], atol=1e-6)
    assert_allclose(ends(heads, 0, 1)[0], [[2, 2, -1]], atol=1e-6)


@pytest.mark.parametrize(("head_length", "name"), [(99.0, "heads"), (-1.0, "shafts")])
def test_a_head_is_no_longer_than_its_arrow_and_no_shorter_than_nothing(
    head_length: float, name: str
):
    points = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0)]
    found = shown(marker(Kind.ARROW, points=points, scale=(0.1, 0.2, head_length)))
    assert list(found) == [name]
    solid = found[name]
    assert isinstance(solid, Solids)
    assert_allclose(solid.scales[:, 2], 4)


def test_an_arrow_by_two_points_is_turned_and_moved_by_its_pose_too():
    one = marker(
        Kind.ARROW, wxyz=QUARTER_ABOUT_Z, points=[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)],
        scale=(0.1, 0.2, 0.3),
    )  # fmt: skip
    assert_allclose(ends(parts(one)[1], 0, 1)[0], [[1, 3, 3]], atol=1e-6)


def test_three_points_make_no_arrow_between_points_as_in_rviz():
    one = marker(Kind.ARROW, points=[(9.0, 9.0, 9.0)] * 3, scale=(1.0, 0.1, 0.1))
    assert_allclose(ends(parts(one)[1], 0, 1)[0], [[2, 2, 3]], atol=1e-6)


def test_a_strip_of_arrows_goes_from_point_to_point():
    points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 2.0, 0.0)]
    one = marker(Kind.ARROW_STRIP, at=(0.0, 0.0, 0.0), points=points, scale=(0.1, 0.2, 0.0))
    shafts, heads = parts(one)
    assert_allclose(ends(shafts, -0.5, 0.5)[0], points[:2], atol=1e-6)
    assert_allclose(ends(heads, 0, 1)[0], points[1:], atol=1e-6)
    assert_allclose(heads.scales[:, 2], [0.25, 0.5], rtol=1e-6)


def test_arrows_to_nowhere_draw_nothing():
    nowhere = marker(Kind.ARROW, points=[(1.0, 0.0, 0.0)] * 2)
    assert shown(nowhere, marker(Kind.ARROW, 1, points=[(1.0, 0.0, 0.0)])) == {}


def test_all_arrows_of_a_namespace_are_two_shapes_with_a_colour_each():
    shafts, heads = parts(
        *(
            marker(Kind.ARROW, each, rgba=(each / 10, 0.0, 0.0, 1.0 - each / 20))
            for each in range(9)
        )
    )
    assert len(shafts.positions) == len(heads.positions) == 9
    assert shafts.colors.tolist() == heads.colors.tolist()
    assert np.ravel(heads.opacities).size == 9


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(*[st.floats(-5, 5)] * 3), min_size=2, max_size=2))
def test_between_any_two_points_the_tip_is_at_the_second(points: list[tuple[float, float, float]]):
    tail, tip = np.array(points)
    found = shown(marker(Kind.ARROW, at=(0.0, 0.0, 0.0), points=points, scale=(0.1, 0.2, 0.0)))
    if np.linalg.norm(tip - tail) < 1e-3:
        return
    shafts, heads = found["shafts"], found["heads"]
    assert isinstance(shafts, Solids)
    assert isinstance(heads, Solids)
    assert_allclose(ends(shafts, -0.5, 0.5)[0][0], tail, atol=1e-5)
    assert_allclose(ends(heads, 0, 1)[0][0], tip, atol=1e-5)
    assert_allclose(ends(heads, 0, 1)[1][0], ends(shafts, -0.5, 0.5)[1][0], atol=1e-5)
