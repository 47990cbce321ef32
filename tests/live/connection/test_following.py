"""Positions between two threads: newest of each joint, told apart from joints of others."""

from __future__ import annotations

from studio.live.connection.following import SILENT_AFTER_S, Following


class Clock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def test_the_newest_position_of_each_joint_is_collected_once():
    following = Following(Clock(), ["a", "b"])
    following.take({"a": 1.0})
    following.take({"b": 5.0})
    following.take({"a": 2.0})
    assert following.collect() == {"a": 2.0, "b": 5.0}
    assert following.collect() == {}


def test_joints_that_the_robot_does_not_have_are_named_but_not_kept():
    following = Following(Clock(), ["a"])
    following.take({"a": 1.0, "x": 2.0} | {f"y{n}": 0.0 for n in range(1000)})
    assert following.collect() == {"a": 1.0}
    assert following.strangers()[0] == "x"
    assert len(following.strangers()) == 12
    following.fit(["a", "x"])
    assert following.strangers() == ()
    following.take({"x": 3.0})
    assert following.collect() == {"x": 3.0}


def test_positions_have_the_stamp_of_the_last_message_that_was_collected():
    following = Following(Clock(), ["a"])
    following.take({"a": 1.0}, 7)
    assert following.stamp_ns == 0
    following.collect()
    following.take({"a": 2.0}, 8)
    assert following.stamp_ns == 7
    following.collect()
    following.take({"a": 2.0})
    following.collect()
    assert following.stamp_ns == 0


def test_it_waits_then_lives_then_is_silent_and_lives_again():
    clock = Clock()
    following = Following(clock, ["a"])
    assert (following.state(), following.rate_hz()) == ("waiting", 0)
    following.take({})
    assert following.state() == "live"
    clock.now_s += SILENT_AFTER_S
    assert following.state() == "silent"
    following.take({})
    assert following.state() == "live"


def test_the_rate_counts_the_last_second():
    clock = Clock()
    following = Following(clock, ["a"])
    for _ in range(30):
        following.take({"a": 0.0})
        clock.now_s += 0.125
    assert following.rate_hz() == 7
