"""Rates over a sliding window, at times that the test chooses."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.ros.node.topic_statistics import Arrivals, Flow

SECOND = 1_000_000_000


def steady(hertz: float, seconds: float, payload_bytes: int = 100) -> tuple[Arrivals, int]:
    """What came so often for so long, and when that ended."""
    arrivals, period_ns = Arrivals(0), int(SECOND / hertz)
    end_ns = int(seconds * SECOND)
    for at_ns in range(period_ns, end_ns + 1, period_ns):
        arrivals.count(at_ns, 1, payload_bytes)
    return arrivals, end_ns


@pytest.mark.parametrize(
    ("hertz", "seconds"), [(0.1, 40), (0.5, 20), (1, 9), (10, 9), (60, 9), (999, 5)]
)
def test_a_steady_topic_has_its_rate_and_its_bytes(hertz: float, seconds: float):
    arrivals, now_ns = steady(hertz, seconds, payload_bytes=250)

    flow = arrivals.flow(now_ns)

    assert flow.rate_hz == pytest.approx(hertz, rel=0.01)
    assert flow.bytes_per_s == pytest.approx(250 * hertz, rel=0.01)
    assert not flow.is_silent


def test_a_rate_does_not_depend_on_when_it_is_asked_for():
    arrivals, now_ns = steady(1, 9)

    assert arrivals.flow(now_ns).rate_hz == arrivals.flow(now_ns + SECOND // 2).rate_hz


def test_a_topic_that_changes_its_rate_has_the_new_one_after_the_window():
    arrivals, now_ns = steady(100, 9)

    for step in range(1, 60):
        arrivals.count(now_ns + step * SECOND // 10, 1, 1)

    assert arrivals.flow(now_ns + 6 * SECOND).rate_hz == pytest.approx(10, rel=0.05)


def test_a_topic_is_silent_once_it_did_not_come_for_three_of_its_periods_and_three_seconds():
    fast, now_ns = steady(100, 9)
    slow, slow_now_ns = steady(0.1, 40)

    assert not fast.flow(now_ns + 2 * SECOND).is_silent
    assert fast.flow(now_ns + 4 * SECOND) == Flow(age_s=4.0, is_silent=True)
    assert not slow.flow(slow_now_ns + 25 * SECOND).is_silent
    assert slow.flow(slow_now_ns + 31 * SECOND) == Flow(age_s=31.0, is_silent=True)


def test_of_what_never_came_there_is_no_age_and_it_is_silent_after_a_while():
    arrivals = Arrivals(5 * SECOND)

    assert arrivals.flow(6 * SECOND) == Flow()
    assert arrivals.flow(9 * SECOND) == Flow(is_silent=True)


def test_one_alone_makes_no_rate():
    arrivals = Arrivals(0)

    arrivals.count(SECOND, 1, 10)

    assert arrivals.flow(2 * SECOND) == Flow(age_s=1.0)


def test_a_topic_that_comes_back_has_its_rate_at_once():
    arrivals, now_ns = steady(10, 9)

    back_ns = now_ns + 20 * SECOND
    for step in range(10):
        arrivals.count(back_ns + step * SECOND // 10, 1, 1)

    assert arrivals.flow(back_ns + SECOND).rate_hz == pytest.approx(10, rel=0.01)


@given(st.lists(st.tuples(st.integers(0, 10 * SECOND), st.integers(1, 500)), max_size=60))
def test_whatever_comes_whenever_the_numbers_are_finite_and_not_below_zero(
    came: list[tuple[int, int]],
):
    arrivals, now_ns = Arrivals(0), 0
    for pause_ns, samples in came:
        now_ns += pause_ns
        arrivals.count(now_ns, samples, 10 * samples)

        flow = arrivals.flow(now_ns)

        assert 0 <= flow.rate_hz < float("inf")
        assert flow.bytes_per_s == pytest.approx(10 * flow.rate_hz)
        assert flow.age_s == 0
