from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.live.time.playhead import Playhead
from tests.support.transforms import S

BEGIN, END = 100 * S, 160 * S


def test_time_goes_on_at_its_rate_and_stops_at_the_end():
    head = Playhead(BEGIN, playing=True, rate=2.0).advanced(3 * S, BEGIN, END)
    assert (head.at_ns, head.playing) == (BEGIN + 6 * S, True)
    ended = head.advanced(60 * S, BEGIN, END)
    assert (ended.at_ns, ended.playing) == (END, False)
    assert Playhead(BEGIN).advanced(S, BEGIN, END) == Playhead(BEGIN)


def test_who_plays_at_the_end_begins_again():
    head = Playhead(END).started(BEGIN, END)
    assert (head.at_ns, head.playing) == (BEGIN, True)
    looped = Playhead(END, loop=(BEGIN + S, BEGIN + 2 * S)).started(BEGIN, END)
    assert looped.at_ns == BEGIN + S
    assert Playhead(BEGIN + S).started(BEGIN, END).at_ns == BEGIN + S


def test_a_loop_begins_again_from_within_and_not_from_behind_it():
    loop = BEGIN + 10 * S, BEGIN + 12 * S
    within = Playhead(BEGIN + 11 * S, playing=True, loop=loop)
    assert within.advanced(round(1.5 * S), BEGIN, END).at_ns == BEGIN + round(10.5 * S)
    behind = Playhead(BEGIN + 20 * S, playing=True, loop=loop)
    assert behind.advanced(S, BEGIN, END).at_ns == BEGIN + 21 * S


@given(
    st.integers(BEGIN, END),
    st.integers(0, 10**12),
    st.floats(0.1, 10.0),
    st.tuples(st.integers(BEGIN, END), st.integers(BEGIN, END)).map(sorted),
)
def test_it_never_leaves_the_recording(at_ns: int, elapsed_ns: int, rate: float, loop: list[int]):
    for one in (None, (loop[0], loop[1])):
        head = Playhead(at_ns, playing=True, rate=rate, loop=one)
        assert BEGIN <= head.advanced(elapsed_ns, BEGIN, END).at_ns <= END
    assert BEGIN <= Playhead(at_ns).within(at_ns - elapsed_ns, BEGIN, END).at_ns <= END
