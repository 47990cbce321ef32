from __future__ import annotations

import numpy as np
import pytest

from studio.course.rover.drive import REACH_M, Drive
from studio.course.rover.room import clearance_m
from studio.course.rover.round_trip import RoundTrip


def test_the_way_is_closed_and_keeps_clear_of_walls():
    way = RoundTrip().path_m
    gaps = np.hypot(*(np.roll(way, -1, axis=0) - way).T)
    assert gaps.max() < 0.15
    assert min(clearance_m(x, y) for x, y in way) > REACH_M + 0.1


def test_the_plan_begins_where_the_rover_is():
    trip = RoundTrip()
    plan = trip.plan_from(2.6, 0.0)
    assert plan.shape == trip.path_m.shape
    assert plan[0] == pytest.approx([2.6, 0.0], abs=0.06)


@pytest.mark.parametrize("start", [(0.0, -2.2, 0.0), (0.0, -2.2, 3.1), (-4.4, 3.3, 1.0)])
def test_the_rover_goes_round_from_anywhere_and_stays_near_the_way(
    start: tuple[float, float, float],
):
    trip, rover = RoundTrip(), Drive(*start)
    seen: set[int] = set()
    off: list[float] = []
    for step in range(round(100 / 0.02)):
        rover.command(*trip.steer(rover.x, rover.y, rover.yaw))
        assert rover.step(0.02)
        gaps = np.hypot(*(trip.path_m - (rover.x, rover.y)).T)
        seen.add(int(gaps.argmin()))
        off += [gaps.min()] if step > 1000 else []
    assert len(seen) > 0.95 * len(trip.path_m)
    assert max(off) < 0.25
