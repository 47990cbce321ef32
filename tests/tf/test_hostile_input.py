"""Whatever peers tell, in whatever order: the buffer answers, and what it answers is finite."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import FrameError
from studio.tf.buffer import HISTORY_NS, TransformBuffer
from tests.support.transforms import HandClock, S, Told, columns

NAMES = st.sampled_from(["", "/", "a", "/a", "b", "c", "d", "e", "f" * 300])
NUMBERS = st.one_of(
    st.floats(-10, 10), st.sampled_from([math.nan, math.inf, -math.inf, 1e12, -1e300, 5e-324])
)
TURNS = st.one_of(
    st.sampled_from([(1.0, 0.0, 0.0, 0.0), (0.6, 0.0, -0.8, 0.0), (-0.5, 0.5, 0.5, -0.5)]),
    st.just((1e308, 1e308, -1e308, 1e308)),
    st.tuples(*[NUMBERS] * 4),
)
STAMPS = st.one_of(
    st.integers(0, 30 * S), st.sampled_from([0, -1, 2**62, 100 * S, 100 * S - HISTORY_NS])
)
ROWS = st.builds(Told, NAMES, NAMES, STAMPS, st.tuples(*[NUMBERS] * 3), TURNS)
MESSAGES = st.lists(
    st.tuples(
        st.lists(ROWS, max_size=6),
        st.booleans(),
        st.sampled_from(["", "one", "two"]),
        st.integers(-S, 20 * S),
    ),
    max_size=25,
)


@given(MESSAGES, STAMPS)
@settings(max_examples=80)
def test_no_message_harms_the_buffer(
    messages: list[tuple[list[Told], bool, str, int]], asked_ns: int
):
    clock = HandClock()
    buffer = TransformBuffer(clock=clock)
    for rows, static, publisher, passed_ns in messages:
        clock.now_ns += passed_ns
        left_out = [
            one.left_out for one in buffer.put(columns(*rows), static=static, publisher=publisher)
        ]
        assert len(left_out) <= len(rows)
    names = buffer.frames()
    assert not {"", "/a", "f" * 300} & set(names)
    for fixed in (*names, "nowhere"):
        for stamp_ns in (0, asked_ns):
            frames = buffer.all_in(fixed, stamp_ns)
            assert np.isfinite(frames.wxyz_xyz[frames.connected]).all()
            assert np.isfinite(frames.ages_s).all()
            assert (frames.ages_s >= 0).all()
            for name in names:
                is_connected = bool(frames.connected[frames.rows[name]])
                assert_alike(buffer, fixed, name, stamp_ns, is_connected)
    report = buffer.report()
    assert [one.frame for one in report] == names
    assert all(math.isfinite(one.rate_hz) and one.rate_hz >= 0 for one in report)
    buffer.jump_back(asked_ns)
    buffer.drop(names)
    assert buffer.frames() == []


def assert_alike(
    buffer: TransformBuffer, fixed: str, name: str, stamp_ns: int, is_connected: bool
) -> None:
    """One frame alone has a pose when it is connected among all, and only then."""
    try:
        pose = buffer.fixed_from(fixed, name, stamp_ns)
    except FrameError:
        # At the newest time, a transform on the way may be too young for the others.
        assert stamp_ns == 0 or not is_connected
    else:
        assert is_connected
        assert all(map(math.isfinite, (*pose.wxyz, *pose.xyz)))
