"""How often joint states become TF: by their own stamps, whatever the clock does."""

from __future__ import annotations

from studio.nodes.robot_state_publisher import StatePace

MS = 1_000_000
NOW = 10_000_000_000_000


def test_what_comes_sooner_than_the_frequency_is_left_out():
    pace = StatePace(20.0)
    due = [pace.is_due(["a"], NOW + at * MS, NOW + at * MS) for at in range(0, 201, 10)]
    assert due.count(True) == 5


def test_joints_of_several_publishers_have_a_pace_each():
    pace = StatePace(20.0)
    assert pace.is_due(["a"], NOW, NOW)
    assert pace.is_due(["b"], NOW, NOW)
    assert pace.is_due(["a", "c"], NOW + MS, NOW + MS), "c was never told"
    assert not pace.is_due(["b"], NOW + MS, NOW + MS)


def test_stamps_that_are_to_be_ignored_hold_nothing_back():
    pace = StatePace(20.0, ignore_stamps=True)
    assert all(pace.is_due(["a"], 0, NOW) for _ in range(3))


def test_stamps_that_stay_the_same_are_told_once():
    pace = StatePace(20.0)
    assert [pace.is_due(["a"], NOW, NOW + at) for at in range(3)] == [True, False, False]


def test_a_clock_that_goes_back_begins_anew():
    pace = StatePace(20.0)
    assert pace.is_due(["a"], NOW, NOW)
    assert pace.is_due(["a"], 5 * MS, 5 * MS)
    assert not pace.is_due(["a"], 6 * MS, 6 * MS)
