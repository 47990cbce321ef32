from __future__ import annotations

import numpy as np

from studio.displays.polygon import PolygonDisplay
from studio.displays.poses import chosen_rows, drawable_poses, poses_of_rows
from tests.support.display_messages import TYPES
from tests.support.drawn import said

ALL = np.arange(40.0).reshape(10, 4)
EACH = np.ones(10, dtype=np.bool_)


def test_rows_that_all_can_be_drawn_are_the_same_array():
    teller = PolygonDisplay(TYPES)
    assert chosen_rows(ALL, EACH, "corners", 10, teller) is ALL
    assert said(teller) == []


def test_too_many_are_spread_evenly_with_both_ends():
    teller = PolygonDisplay(TYPES)
    chosen = chosen_rows(ALL, EACH, "corners", 4, teller)
    assert chosen is not None
    assert (chosen[:, 0] / 4).tolist() == [0.0, 3.0, 6.0, 9.0]
    assert teller.statuses()[0].sentence.startswith("Showing 4 of 10 corners")


def test_what_is_left_out_for_two_reasons_is_told_twice():
    teller = PolygonDisplay(TYPES)
    sound = EACH.copy()
    sound[0] = False
    chosen = chosen_rows(ALL, sound, "corners", 2, teller)
    assert chosen is not None
    assert (chosen[:, 0] / 4).tolist() == [1.0, 9.0]
    assert said(teller) == [("warn", "not_finite"), ("ok", "thinned")]


def test_a_pose_needs_a_place_within_bounds_and_a_direction_of_any_length():
    rows = np.zeros((5, 7))
    rows[0, 0], rows[1, 6], rows[2, 3], rows[3, 2] = np.nan, np.inf, 1e308, -1e13
    assert drawable_poses(rows).tolist() == [False, False, True, False, True]


def test_the_quaternion_of_the_wire_has_its_w_last():
    poses = poses_of_rows(np.array([[1.0, 2, 3, 0, 0, 0, 5]]), "poses", 9, PolygonDisplay(TYPES))
    assert poses is not None
    assert poses.xyz.tolist() == [[1.0, 2.0, 3.0]]
    assert poses.wxyz.tolist() == [[1.0, 0.0, 0.0, 0.0]]
