from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.robot.meshes.triangulation import fan_corners, polygon_corners, strip_corners


def star(radii: list[float]) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    """A polygon round the origin, counter-clockwise, with dents wherever a radius is small."""
    turn = 2 * math.pi / len(radii)
    points = [(r * math.cos(n * turn), r * math.sin(n * turn), 1.0) for n, r in enumerate(radii)]
    return np.array(points, dtype=np.float32)


def areas(
    points: np.ndarray[tuple[int, ...], np.dtype[np.float32]],
    corners: np.ndarray[tuple[int, ...], np.dtype[np.int64]],
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Area of each triangle, negative for those that look down."""
    a, b, c = np.moveaxis(points.astype(np.float64)[corners.reshape(-1, 3)], 1, 0)
    return np.cross(b - a, c - a)[:, 2] / 2


def shoelace(points: np.ndarray[tuple[int, ...], np.dtype[np.float32]]) -> float:
    x, y = points[:, 0].astype(float), points[:, 1].astype(float)
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


@given(st.lists(st.floats(0.1, 1.0), min_size=4, max_size=30))
def test_a_polygon_with_dents_is_covered_once_and_looks_up(radii: list[float]):
    points = star(radii)
    covered = areas(points, polygon_corners(np.array([len(radii)]), points))
    assert len(covered) == len(radii) - 2
    assert covered.min() > -1e-5
    assert covered.sum() == pytest.approx(shoelace(points), abs=1e-4)


def test_a_dart_is_split_at_its_dent():
    dart = np.array([(0, 0, 0), (2, 1, 0), (0.5, 1, 0), (0, 2, 0)], dtype=np.float32)[[1, 2, 3, 0]]
    assert areas(dart, polygon_corners(np.array([4]), dart)).min() > 0


def test_polygons_of_all_sizes_stand_side_by_side():
    points = np.concatenate([star([1, 1, 1]), star([1, 0.1, 1, 0.1, 1]), star([1, 1, 1, 1])])
    corners = polygon_corners(np.array([3, 5, 4]), points)
    assert len(corners) == 3 * (1 + 3 + 2)
    assert areas(points, corners).min() > 0


def test_lines_and_points_give_no_triangle():
    points = np.zeros((6, 3), dtype=np.float32)
    assert polygon_corners(np.array([1, 2, 0, 3]), points).tolist() == [3, 4, 5]
    assert polygon_corners(np.zeros(0, dtype=np.int64), points).tolist() == []


def test_points_without_area_or_at_infinity_end_too():
    for value in (0.0, np.inf, np.nan):
        points = np.full((9, 3), value, dtype=np.float32)
        assert len(polygon_corners(np.array([9]), points)) == 21


def test_a_strip_turns_every_second_triangle():
    assert strip_corners(np.array([5])).tolist() == [0, 1, 2, 1, 3, 2, 2, 3, 4]


def test_a_fan_starts_at_its_first_corner():
    assert fan_corners(np.array([3, 4])).tolist() == [0, 1, 2, 3, 4, 5, 3, 5, 6]
