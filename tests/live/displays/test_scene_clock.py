from __future__ import annotations

import time

import pytest

from studio.live.displays.scene_clock import SceneClock

S = 1_000_000_000


class Wall:
    """A clock of the machine that a test sets."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now_s = 1_700_000_000
        monkeypatch.setattr(time, "time_ns", lambda: self.now_s * S)


@pytest.fixture
def wall(monkeypatch: pytest.MonkeyPatch) -> Wall:
    return Wall(monkeypatch)


def elapsed(clock: SceneClock, clock_ns: int | None) -> tuple[float, float]:
    """ROS and wall time since the beginning."""
    told = clock.told(1, clock_ns, paused=False)
    return told.ros_elapsed_s, told.wall_elapsed_s


def test_without_a_clock_topic_ros_time_is_that_of_the_machine(wall: Wall):
    clock = SceneClock()
    assert elapsed(clock, None) == (0.0, 0.0)
    wall.now_s += 7
    told = clock.told(2, None, paused=False)
    assert (told.ros_s, told.wall_s, told.from_clock) == (wall.now_s, wall.now_s, False)
    assert elapsed(clock, None) == (7.0, 7.0)


def test_simulated_time_is_counted_from_its_own_beginning_and_anew_when_it_goes_back(wall: Wall):
    clock = SceneClock()
    elapsed(clock, None)
    wall.now_s += 10
    assert elapsed(clock, 50 * S) == (0.0, 10.0)
    assert elapsed(clock, 53 * S) == (3.0, 10.0)
    assert elapsed(clock, 2 * S) == (0.0, 10.0)
    assert elapsed(clock, 6 * S) == (4.0, 10.0)


def test_while_it_is_paused_ros_time_stands_and_wall_time_goes_on(wall: Wall):
    clock = SceneClock()
    elapsed(clock, 50 * S)
    clock.pause(52 * S, paused=True)
    wall.now_s += 5
    assert elapsed(clock, 60 * S) == (2.0, 5.0)
    clock.pause(60 * S, paused=False)
    assert elapsed(clock, 60 * S) == (10.0, 5.0)


def test_a_reset_counts_from_then_on(wall: Wall):
    clock = SceneClock()
    elapsed(clock, None)
    wall.now_s += 9
    clock.reset()
    assert elapsed(clock, None) == (0.0, 0.0)
    wall.now_s += 1
    assert elapsed(clock, None) == (1.0, 1.0)
