from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.ros.duration import Duration
from studio.ros.messages import message
from studio.ros.node.clock import ClockType, Time

instants_ns = st.integers(0, 2**31 * 10**9 - 1)


@given(instants_ns)
def test_an_instant_survives_its_message(nanoseconds: int):
    time = Time(nanoseconds=nanoseconds, clock_type=ClockType.ROS_TIME)
    assert Time.from_msg(time.to_msg()) == time


@given(instants_ns, instants_ns)
def test_the_span_between_two_instants_leads_from_one_to_the_other(one_ns: int, other_ns: int):
    one, other = Time(nanoseconds=one_ns), Time(nanoseconds=other_ns)
    assert other + (one - other) == one
    assert one - (one - other) == other


def test_seconds_and_nanoseconds_are_added():
    assert Time(seconds=2, nanoseconds=5).seconds_nanoseconds() == (2, 5)


def test_instants_are_ordered():
    early, late = Time(nanoseconds=1), Time(nanoseconds=2)
    same = Time(nanoseconds=2)
    assert early < late <= same
    assert same >= late > early
    assert len({early, Time(nanoseconds=1)}) == 1


def test_instants_of_different_clocks_do_not_compare():
    with pytest.raises(TypeError, match="STEADY_TIME"):
        _ = Time(nanoseconds=1) < Time(nanoseconds=1, clock_type=ClockType.STEADY_TIME)


def test_an_instant_is_no_number():
    assert Time(nanoseconds=1) != 1


def test_there_is_nothing_before_zero():
    with pytest.raises(ValueError, match="before zero"):
        _ = Time(nanoseconds=1) - Duration(nanoseconds=2)
    with pytest.raises(ValueError, match="before zero"):
        Time.from_msg(message("builtin_interfaces/msg/Time")(sec=-1))
