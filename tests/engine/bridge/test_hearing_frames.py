from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.engine.bridge.hearing_frames import Tick, chunk_of, frame_of
from studio.ros.attachment import Attachment
from studio.ros.node.inbox import RawSample
from tests.support.hearers import Came, read_frame

PAYLOADS = st.lists(st.binary(max_size=40), max_size=6)
GID = bytes(16)


def samples(payloads: list[bytes]) -> list[RawSample]:
    return [
        RawSample(one, Attachment(at, 1_000 + at, GID), 2_000 + at)
        for at, one in enumerate(payloads)
    ]


@given(PAYLOADS, PAYLOADS, st.integers(0, 2**32 - 1))
def test_a_frame_gives_every_message_back_as_it_was(
    first: list[bytes], other: list[bytes], dropped: int
):
    chunks = (
        chunk_of(7, samples(first), 3, keeps_all=True),
        chunk_of(9, samples(other), 0, keeps_all=False),
    )
    expected = [Came(7, one, 2_000 + at, 1_000 + at, 3) for at, one in enumerate(first)]
    expected += [Came(9, one, 2_000 + at, 1_000 + at, 0) for at, one in enumerate(other)]
    assert read_frame(frame_of(chunks, dropped)) == (dropped, expected)


def test_the_frame_of_a_tick_is_written_once_for_all():
    tick = Tick((chunk_of(1, samples([b"abcd"]), 0, keeps_all=True),))
    assert tick.frame is tick.frame
