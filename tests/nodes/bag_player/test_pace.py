from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from studio.nodes.bag_player.pace import Pace


class Steady:
    """A clock that goes when a test says so."""

    def __init__(self) -> None:
        self.ns = 5

    def __call__(self) -> int:
        return self.ns


@given(st.lists(st.tuples(st.integers(0, 10**12), st.floats(0.01, 100))))
def test_time_is_the_sum_of_what_went_by_at_each_rate(steps: list[tuple[int, float]]):
    steady = Steady()
    pace = Pace(1_000, steady_ns=steady)
    expected = 1_000.0
    for took_ns, rate in steps:
        assert pace.set_rate(rate)
        steady.ns += took_ns
        expected += took_ns * rate
    assert abs(pace.now_ns() - expected) <= len(steps) + 1 + expected * 1e-12


@given(st.integers(0, 10**15), st.floats(0.01, 100), st.integers(0, 10**12))
def test_what_is_left_is_when_the_time_comes(ahead_ns: int, rate: float, passed_ns: int):
    steady = Steady()
    pace = Pace(0, rate, steady_ns=steady)
    steady.ns += passed_ns
    left_s = pace.left_s(ahead_ns)
    steady.ns += math.ceil(left_s * 1e9) + 1
    assert pace.now_ns() >= ahead_ns - 1
    assert pace.left_s(ahead_ns) == 0


def test_it_stands_while_it_is_paused_and_goes_on_from_there():
    steady = Steady()
    pace = Pace(100, is_paused=True, steady_ns=steady)
    steady.ns += 50
    assert (pace.now_ns(), pace.left_s(100)) == (100, math.inf)
    pace.resume()
    steady.ns += 50
    assert pace.now_ns() == 150
    pace.pause()
    steady.ns += 50
    pace.jump(7)
    pace.pause()
    assert (pace.now_ns(), pace.is_paused) == (7, True)


def test_no_rate_is_below_or_at_zero_or_without_end():
    pace = Pace(0)
    assert [pace.set_rate(one) for one in (0, -1, math.nan, math.inf, 1e305)] == [False] * 5
    assert pace.rate == 1
