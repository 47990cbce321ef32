from __future__ import annotations

import pytest

from studio.ros.node.clock import Clock, ClockType
from studio.ros.node.timer import Timer
from studio.ros.node.work import MutuallyExclusiveCallbackGroup


def told_timer(period_ns: int, callback: list[int]) -> tuple[Clock, Timer]:
    """A timer on a clock that the test tells."""
    clock = Clock(clock_type=ClockType.ROS_TIME)
    clock.set_ros_time(0)
    timer = Timer(
        lambda: callback.append(clock.now_ns()),
        period_ns,
        clock,
        MutuallyExclusiveCallbackGroup(),
    )
    return clock, timer


def run_at(clock: Clock, timer: Timer, now_ns: int) -> None:
    clock.set_ros_time(now_ns)
    run = timer.take()
    if run is not None:
        run()


def test_a_timer_that_is_late_does_not_drift():
    called: list[int] = []
    clock, timer = told_timer(10, called)
    for now_ns in (9, 10, 13, 21, 30):
        run_at(clock, timer, now_ns)
    assert called == [10, 21, 30]


def test_periods_that_were_missed_are_left_out():
    called: list[int] = []
    clock, timer = told_timer(10, called)
    for now_ns in (57, 59, 60):
        run_at(clock, timer, now_ns)
    assert called == [57, 60]


def test_a_jump_backwards_begins_a_period_anew():
    called: list[int] = []
    clock, timer = told_timer(10, called)
    for now_ns in (10, 20, 3, 12, 13, 23):
        run_at(clock, timer, now_ns)
    assert called == [10, 20, 13, 23]


def test_a_cancelled_timer_is_never_ready_until_it_is_reset():
    called: list[int] = []
    clock, timer = told_timer(10, called)
    timer.cancel()
    run_at(clock, timer, 25)
    assert (timer.is_canceled(), timer.time_until_next_call(), called) == (True, None, [])
    timer.reset()
    run_at(clock, timer, 34)
    run_at(clock, timer, 35)
    assert called == [35]


def test_a_timer_tells_how_long_since_and_until_its_calls():
    clock, timer = told_timer(10, [])
    run_at(clock, timer, 12)
    clock.set_ros_time(17)
    assert timer.time_since_last_call() == 5
    assert timer.time_until_next_call() == 3
    timer.timer_period_ns = 4
    assert (timer.timer_period_ns, timer.time_until_next_call()) == (4, 4)


def test_a_timer_that_does_not_start_by_itself_waits_for_reset():
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    group = MutuallyExclusiveCallbackGroup()
    timer = Timer(None, 0, clock, group, autostart=False)
    assert (timer.is_ready, timer.due_s) == (False, None)
    timer.reset()
    assert timer.is_ready


def test_told_time_is_not_waited_for_by_the_steady_clock():
    clock, timer = told_timer(10, [])
    assert timer.due_s is None
    clock.set_ros_time(10)
    assert timer.due_s is not None


def test_a_period_is_not_below_zero():
    with pytest.raises(ValueError, match="below zero"):
        told_timer(-1, [])


def test_a_destroyed_timer_is_told_no_more():
    called: list[int] = []
    clock, timer = told_timer(10, called)
    timer.destroy()
    run_at(clock, timer, 50)
    assert called == []
