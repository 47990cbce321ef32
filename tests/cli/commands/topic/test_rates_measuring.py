from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.cli.commands.topic.rates import Bandwidth, Delay, Rate


def test_t3_a_source_of_30_hz_is_measured():
    rate = Rate()
    for number in range(91):
        rate.add(100 + number / 30 + (0.001 if number % 2 else 0))
    report = rate.report()
    assert report is not None
    assert report.startswith("average rate: 30.0")
    assert "min: 0.032s max: 0.034s" in report
    assert report.endswith("window: 91")


def test_nothing_is_said_before_the_second_sample():
    rate, delay, size = Rate(), Delay(), Bandwidth()
    rate.add(1)
    size.add(1, 10)
    assert (rate.report(), delay.report(), size.report(2)) == (None, None, None)


def test_a_clock_that_goes_backwards_begins_anew():
    rate = Rate()
    for time_s in (10, 11, 2, 2.5):
        rate.add(time_s)
    assert rate.hertz == 2


def test_only_the_newest_of_the_window_count():
    rate = Rate(window=2)
    for time_s in (0, 10, 10.5, 11):
        rate.add(time_s)
    assert rate.hertz == 2


@pytest.mark.parametrize(
    ("size_bytes", "said"),
    [(24, "48 B/s from 2 messages"), (24_000, "48.00 KB/s"), (24_000_000, "48.00 MB/s")],
)
def test_bandwidth_has_the_unit_of_its_rate(size_bytes: int, said: str):
    bandwidth = Bandwidth()
    bandwidth.add(0, size_bytes)
    bandwidth.add(0.5, size_bytes)
    report = bandwidth.report(1.0)
    assert report is not None
    assert report.startswith(said)


def test_delay_is_that_of_the_stamps():
    delay = Delay()
    for delay_s in (0.01, 0.03):
        delay.add(delay_s)
    assert delay.report() == (
        "average delay: 0.020\n\tmin: 0.010s max: 0.030s std dev: 0.01000s window: 2"
    )


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False, width=32), max_size=20))
def test_any_times_are_measured(times: list[float]):
    rate = Rate()
    for time_s in times:
        rate.add(time_s)
    assert rate.hertz is None or rate.hertz > 0
