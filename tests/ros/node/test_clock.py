from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

import pytest

from studio.ros.duration import Duration
from studio.ros.node.clock import Clock, ClockChange, ClockType, JumpThreshold, Time, TimeJump
from tests.support.node_pair import context_at
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.context import Context

SECOND_NS = 10**9


@pytest.fixture
def context() -> Generator[Context]:
    with running_router() as endpoint, context_at(endpoint) as found:
        yield found


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
    clock.set_ros_time(5)
    assert (clock.ros_time_is_active, clock.now_ns()) == (True, 5)
    clock.set_ros_time(None)
    assert abs(clock.now_ns() - time.time_ns()) < SECOND_NS


def test_only_ros_time_is_told():
    with pytest.raises(ValueError, match="ROS time"):
        Clock().set_ros_time(1)


def test_a_jump_backwards_is_told_with_its_length():
    clock = ros_clock()
    clock.set_ros_time(9 * SECOND_NS)
    jumps = told_at(clock, JumpThreshold(min_backward=Duration(seconds=-2)))
    clock.set_ros_time(8 * SECOND_NS)
    clock.set_ros_time(20 * SECOND_NS)
    clock.set_ros_time(3 * SECOND_NS)
    assert jumps == [TimeJump(ClockChange.ROS_TIME_NO_CHANGE, Duration(seconds=-17))]


def test_a_jump_forwards_is_told_when_it_is_long_enough():
    clock = ros_clock()
    clock.set_ros_time(0)
    jumps = told_at(clock, JumpThreshold(min_forward=Duration(seconds=5)))
    for second in (4, 8, 20):
        clock.set_ros_time(second * SECOND_NS)
    assert [jump.delta for jump in jumps] == [Duration(seconds=12)]


def test_taking_over_and_giving_back_are_told():
    clock = ros_clock()
    jumps = told_at(clock, JumpThreshold())
    clock.set_ros_time(1)
    clock.set_ros_time(2)
    clock.set_ros_time(None)
    assert [jump.clock_change for jump in jumps] == [
        ClockChange.ROS_TIME_ACTIVATED,
        ClockChange.ROS_TIME_DEACTIVATED,
    ]


def test_before_and_after_are_told_around_the_jump():
    clock = ros_clock()
    seen: list[int] = []
    clock.set_ros_time(1)
    handle = clock.create_jump_callback(
        JumpThreshold(min_forward=Duration(nanoseconds=1)),
        pre_callback=lambda: seen.append(clock.now_ns()),
        post_callback=lambda _: seen.append(clock.now_ns()),
    )
    clock.set_ros_time(7)
    handle.unregister()
    handle.unregister()
    clock.set_ros_time(9)
    assert seen == [1, 7]


def test_sleeping_lasts_as_long_as_it_should(context: Context):
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    begin_ns = clock.now_ns()
    assert clock.sleep_for(Duration(seconds=0.01), context)
    assert clock.now_ns() - begin_ns >= 10_000_000


def test_sleeping_by_told_time_ends_when_it_is_told(context: Context):
    clock = ros_clock()
    clock.set_ros_time(0)
    until = Time(seconds=5, clock_type=ClockType.ROS_TIME)
    slept: list[bool] = []
    thread = threading.Thread(target=lambda: slept.append(clock.sleep_until(until, context)))
    thread.start()
    clock.set_ros_time(4 * SECOND_NS)
    assert slept == []
    clock.set_ros_time(5 * SECOND_NS)
    thread.join()
    assert slept == [True]


def test_sleeping_ends_with_the_context(context: Context):
    slept: list[bool] = []
    thread = threading.Thread(
        target=lambda: slept.append(Clock().sleep_for(Duration(seconds=600), context))
    )
    thread.start()
    context.end()
    thread.join()
    assert slept == [False]


def test_an_instant_of_another_clock_is_not_slept_for(context: Context):
    with pytest.raises(ValueError, match="another clock"):
        Clock().sleep_until(Time(clock_type=ClockType.ROS_TIME), context)
