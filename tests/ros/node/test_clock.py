from __future__ import annotations

import time

import pytest

from studio.ros.duration import Duration
from studio.ros.node.clock import Clock, ClockChange, JumpThreshold, TimeJump
from studio.ros.node.time import ClockType

SECOND_NS = 10**9


def ros_clock() -> Clock:
    return Clock(clock_type=ClockType.ROS_TIME)


def told_at(clock: Clock, threshold: JumpThreshold) -> list[TimeJump]:
    jumps: list[TimeJump] = []
    clock.create_jump_callback(threshold, post_callback=jumps.append)
    return jumps


def test_a_clock_of_the_system_tells_its_time():
    before_ns = time.time_ns()
    assert before_ns <= Clock().now_ns() <= time.time_ns()


def test_a_steady_clock_counts_from_a_zero_of_its_own():
    now = Clock(clock_type=ClockType.STEADY_TIME).now()
    assert now.clock_type is ClockType.STEADY_TIME
    assert now.nanoseconds <= time.monotonic_ns()


def test_ros_time_is_the_systems_until_it_is_told():
    clock = ros_clock()
    assert not clock.ros_time_is_active
    assert abs(clock.now_ns() - time.time_ns()) < SECOND_NS
    clock.tell(5)
    assert (clock.ros_time_is_active, clock.now_ns()) == (True, 5)
    clock.tell(None)
    assert abs(clock.now_ns() - time.time_ns()) < SECOND_NS


def test_only_ros_time_is_told():
    with pytest.raises(ValueError, match="ROS time"):
        Clock().tell(1)


def test_a_jump_backwards_is_told_with_its_length():
    clock = ros_clock()
    clock.tell(9 * SECOND_NS)
    jumps = told_at(clock, JumpThreshold(min_backward=Duration(seconds=-2)))
    clock.tell(8 * SECOND_NS)
    clock.tell(20 * SECOND_NS)
    clock.tell(3 * SECOND_NS)
    assert jumps == [TimeJump(ClockChange.ROS_TIME_NO_CHANGE, Duration(seconds=-17))]


def test_a_jump_forwards_is_told_when_it_is_long_enough():
    clock = ros_clock()
    clock.tell(0)
    jumps = told_at(clock, JumpThreshold(min_forward=Duration(seconds=5)))
    for second in (4, 8, 20):
        clock.tell(second * SECOND_NS)
    assert [jump.delta for jump in jumps] == [Duration(seconds=12)]


def test_taking_over_and_giving_back_are_told():
    clock = ros_clock()
    jumps = told_at(clock, JumpThreshold())
    clock.tell(1)
    clock.tell(2)
    clock.tell(None)
    assert [jump.clock_change for jump in jumps] == [
        ClockChange.ROS_TIME_ACTIVATED,
        ClockChange.ROS_TIME_DEACTIVATED,
    ]


def test_before_and_after_are_told_around_the_jump():
    clock = ros_clock()
    seen: list[int] = []
    clock.tell(1)
    handle = clock.create_jump_callback(
        JumpThreshold(min_forward=Duration(nanoseconds=1)),
        pre_callback=lambda: seen.append(clock.now_ns()),
        post_callback=lambda _: seen.append(clock.now_ns()),
    )
    clock.tell(7)
    handle.unregister()
    handle.unregister()
    clock.tell(9)
    assert seen == [1, 7]
