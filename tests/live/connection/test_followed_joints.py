"""Positions between two threads: newest of each joint, told apart from joints of others."""

from __future__ import annotations

from studio.live.connection.followed_joints import SILENT_AFTER_S, NewestPositions


class Clock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def test_the_newest_position_of_each_joint_is_collected_once():
    newest = NewestPositions(Clock(), ["a", "b"])
    newest.take({"a": 1.0})
    newest.take({"b": 5.0})
    newest.take({"a": 2.0})
    assert newest.collect() == {"a": 2.0, "b": 5.0}
    assert newest.collect() == {}


def test_joints_that_the_robot_does_not_have_are_named_but_not_kept():
    newest = NewestPositions(Clock(), ["a"])
    newest.take({"a": 1.0, "x": 2.0} | {f"y{n}": 0.0 for n in range(1000)})
    assert newest.collect() == {"a": 1.0}
    assert newest.strangers()[0] == "x"
    assert len(newest.strangers()) == 12
    newest.fit(["a", "x"])
    assert newest.strangers() == ()
    newest.take({"x": 3.0})
    assert newest.collect() == {"x": 3.0}


def test_positions_have_the_stamp_of_the_last_message_that_was_collected():
    newest = NewestPositions(Clock(), ["a"])
    newest.take({"a": 1.0}, 7)
    assert newest.stamp_ns == 0
    newest.collect()
    newest.take({"a": 2.0}, 8)
    assert newest.stamp_ns == 7
    newest.collect()
    newest.take({"a": 2.0})
    newest.collect()
    assert newest.stamp_ns == 0


def test_it_waits_then_lives_then_is_silent_and_lives_again():
    clock = Clock()
    newest = NewestPositions(clock, ["a"])
    assert (newest.state(), newest.rate_hz()) == ("waiting", 0)
    newest.take({})
    assert newest.state() == "live"
    clock.now_s += SILENT_AFTER_S
    assert newest.state() == "silent"
    newest.take({})
    assert newest.state() == "live"


def test_the_rate_counts_the_last_second():
    clock = Clock()
    newest = NewestPositions(clock, ["a"])
    for _ in range(30):
        newest.take({"a": 0.0})
        clock.now_s += 0.125
    assert newest.rate_hz() == 7
