from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.course.rover.room import (
    MAP_CELL_M,
    POSTS_M,
    WALLS_M,
    cast_rays,
    clearance_m,
    occupancy,
)

INSIDE = st.tuples(st.floats(-4.9, 4.9), st.floats(-3.9, 3.2))


def test_rays_end_at_walls_and_posts():
    distances, hits = cast_rays(0.0, -2.0, np.array([0.0, math.pi / 2, math.pi, -math.pi / 2]))
    assert distances == pytest.approx([5.0, 1.4, 5.0, 2.0])
    assert hits[1] == 8
    post, hit = cast_rays(3.9, 0.0, np.array([math.pi / 2]))
    assert post == pytest.approx([1.3 - 0.18])
    assert hit[0] == len(WALLS_M)


@given(INSIDE)
def test_no_ray_leaves_the_room(place: tuple[float, float]):
    distances, _ = cast_rays(*place, np.linspace(-math.pi, math.pi, 90))
    assert np.isfinite(distances).all()
    assert (distances >= 0).all()


@given(INSIDE)
def test_the_nearest_ray_is_no_nearer_than_the_clearance(place: tuple[float, float]):
    distances, _ = cast_rays(*place, np.linspace(-math.pi, math.pi, 720))
    clearance = clearance_m(*place)
    assert distances.min() >= clearance - 1e-9
    assert distances.min() == pytest.approx(clearance, abs=0.02)


def test_what_rays_hit_is_taken_on_the_map_and_what_they_cross_is_free():
    cells, x0, y0 = occupancy()

    def cell(x: float, y: float) -> int:
        return int(cells[int((y - y0) / MAP_CELL_M), int((x - x0) / MAP_CELL_M)])

    angles = np.linspace(-math.pi, math.pi, 180)
    for angle, distance in zip(angles, cast_rays(-2.9, -2.2, angles)[0], strict=True):
        far = -2.9 + math.cos(angle) * distance, -2.2 + math.sin(angle) * distance
        half = -2.9 + math.cos(angle) * distance / 2, -2.2 + math.sin(angle) * distance / 2
        assert cell(*far) == 100
        assert cell(*half) == 0
    assert cells[0, 0] == -1
    assert len(POSTS_M) == 3
