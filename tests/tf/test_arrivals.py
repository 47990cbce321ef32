from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.tf.arrivals import WINDOW_NS, Arrivals
from tests.support.transforms import S

KEPT = 64
PAUSES_NS = st.lists(st.integers(0, 4 * S), max_size=KEPT + 30)


def told(pauses_ns: list[int], frames: int = 3) -> tuple[Arrivals, list[int]]:
    """The last of a few frames, told of with these pauses between; and when."""
    arrivals, now_ns, times_ns = Arrivals(), 100 * S, list[int]()
    arrivals.fit(frames)
    for pause_ns in pauses_ns:
        now_ns += pause_ns
        arrivals.note(np.array([frames - 1]), arrivals.publisher("one"), now_ns)
        times_ns.append(now_ns)
    return arrivals, times_ns[-KEPT:]


def rate_hz(times_ns: list[int], now_ns: int) -> float:
    """Between the arrivals of the last seconds; who is silent for longer becomes slower."""
    lately = [at for at in times_ns if at > now_ns - WINDOW_NS]
    if len(lately) < 2 or lately[-1] == lately[0]:
        return 0.0
    between = (len(lately) - 1) / (lately[-1] - lately[0])
    return min(between, len(lately) / (now_ns - lately[0])) * S


def is_stale(times_ns: list[int], now_ns: int) -> bool:
    """Beside the second longest of the last 16 pauses, or the only one."""
    if len(times_ns) < 2:
        return not times_ns or now_ns - times_ns[-1] >= WINDOW_NS
    pauses = sorted(after - before for before, after in pairwise(times_ns[-17:]))
    return now_ns - times_ns[-1] > max(S, 3 * pauses[-2:][0])


@given(PAUSES_NS, st.integers(0, 15 * S))
def test_rates_and_silence_are_those_of_a_plain_list_of_arrivals(
    pauses_ns: list[int], silent_ns: int
):
    arrivals, times_ns = told(pauses_ns)
    now_ns = (times_ns[-1] if times_ns else 100 * S) + silent_ns
    frames = np.array([2, 0])
    rates, stale = arrivals.rates_hz(frames, now_ns), arrivals.are_stale(frames, now_ns)
    assert rates.tolist() == pytest.approx([rate_hz(times_ns, now_ns), 0.0], rel=1e-9)
    assert stale.tolist() == [is_stale(times_ns, now_ns), True]


def test_of_no_frames_nothing_is_said():
    arrivals, nobody = Arrivals(), np.zeros(0, np.int64)
    assert arrivals.rates_hz(nobody, S).tolist() == arrivals.are_stale(nobody, S).tolist() == []
