from __future__ import annotations

import math

import numpy as np
import pytest

from studio.course.rover.camera import (
    FOCAL_PX,
    HEIGHT_PX,
    WIDTH_PX,
    field_of_view_rad,
    intrinsics,
    picture,
)


def test_a_picture_has_floor_below_walls_and_sky_above():
    seen = picture(-2.9, -2.2, 0.0)
    assert seen.shape == (HEIGHT_PX, WIDTH_PX, 3)
    assert seen.dtype == np.uint8
    middle = seen[:, WIDTH_PX // 2].astype(int)
    assert middle[0].min() > 200
    assert not np.array_equal(middle[HEIGHT_PX // 2], middle[0])
    assert not np.array_equal(middle[-1], middle[HEIGHT_PX // 2])


def test_the_picture_changes_with_the_pose():
    ahead = picture(0.0, -2.2, 0.0)
    assert not np.array_equal(ahead, picture(0.0, -2.2, 0.3))
    assert not np.array_equal(ahead, picture(1.0, -2.2, 0.0))


def test_a_near_wall_is_taller_than_a_far_one():
    def wall_rows(x: float) -> int:
        column = picture(x, -2.2, 0.0)[:, WIDTH_PX // 2].astype(int)
        is_wall = np.abs(column - column[HEIGHT_PX // 2]).sum(axis=1) == 0
        return int(is_wall.sum())

    assert wall_rows(4.0) > wall_rows(-3.0)


def test_a_wall_on_the_left_is_left_in_the_picture():
    """A post stands to the left of the way: it is painted as no wall is."""
    seen = picture(1.5, 0.9, 0.0).astype(int)[HEIGHT_PX // 2]
    orange = np.flatnonzero(seen[:, 0] > 1.6 * seen[:, 1])
    assert len(orange)
    assert orange.max() < WIDTH_PX // 2


def test_the_intrinsics_give_the_field_of_view():
    fx, _, cx, cy = intrinsics()
    assert fx == FOCAL_PX
    assert (cx, cy) == (WIDTH_PX / 2 - 0.5, HEIGHT_PX / 2 - 0.5)
    assert math.degrees(field_of_view_rad()) == pytest.approx(59.5, abs=0.1)
