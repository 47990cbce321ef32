"""How often something usually comes, by times that are given."""

from __future__ import annotations

import pytest

from studio.live.doctor.pace import Pace


def pace_of(*spans: tuple[float, float]) -> tuple[Pace, float]:
    """So many seconds at so many a second, one span after the other; and when it ended."""
    pace, now_s = Pace(), 100.0
    for seconds, rate_hz in spans:
        for _ in range(int(seconds * rate_hz)):
            now_s += 1 / rate_hz
            pace.count(now_s, 1)
    return pace, now_s


def test_what_comes_steadily_is_neither_slow_nor_silent():
    pace, now_s = pace_of((30, 10))
    now = pace.now(now_s + 0.05)
    assert (now.is_slow, now.is_silent) == (False, False)
    assert now.usual_hz == pytest.approx(10, rel=0.1)


def test_it_is_silent_after_five_of_its_periods_and_two_seconds():
    pace, now_s = pace_of((10, 20))
    assert not pace.now(now_s + 1.9).is_silent
    assert pace.now(now_s + 2.1).is_silent
    seldom, now_s = pace_of((20, 1))
    assert not seldom.now(now_s + 4).is_silent
    assert seldom.now(now_s + 6).is_silent


def test_what_had_long_pauses_before_is_not_silent_in_another_one():
    pace = Pace()
    for burst in range(4):
        for at in range(10):
            pace.count(100 + burst * 8 + at * 0.05, 1)
    assert not pace.now(100 + 3 * 8 + 12).is_silent
    assert pace.now(100 + 3 * 8 + 18).is_silent


def test_it_is_slow_when_it_comes_clearly_more_seldom_than_it_did():
    pace, now_s = pace_of((20, 20), (4, 8))
    now = pace.now(now_s)
    assert now.is_slow
    assert now.usual_hz == pytest.approx(20, rel=0.1)
    assert now.recent_hz == pytest.approx(8, rel=0.2)
    steady, now_s = pace_of((20, 20), (4, 16))
    assert not steady.now(now_s).is_slow


def test_of_a_few_messages_nothing_is_said():
    pace = Pace()
    assert pace.now(5.0).silent_s is None
    for at in range(4):
        pace.count(at * 0.1, 1)
    assert not pace.now(60.0).is_silent


def test_what_lies_long_back_is_forgotten():
    pace, now_s = pace_of((400, 5), (300, 1))
    assert not pace.now(now_s + 0.1).is_slow
