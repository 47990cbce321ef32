from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from studio.live.topics.frames import LARGE_BYTES, Tick, chunk_of, frame_of, frame_parts
from studio.ros.attachment import Attachment
from studio.ros.node.samples import RawSample
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
    assert tick.frame() is tick.frame()


def test_a_large_message_is_not_copied_to_be_framed():
    large = bytes(LARGE_BYTES + 1)
    chunk = chunk_of(1, samples([large]), 0, keeps_all=False)
    assert chunk.is_large
    assert any(part is large for part in frame_parts((chunk,), 0))
    assert chunk.size == sum(map(len, chunk.parts))
    many_small = chunk_of(1, samples([b"x" * 1_000] * 1_000), 0, keeps_all=True)
    assert not many_small.is_large


def test_what_is_left_of_a_tick_is_the_same_for_all_who_have_the_rest_from_elsewhere():
    chunks = tuple(
        chunk_of(at, samples([bytes(at * LARGE_BYTES)]), 0, keeps_all=False) for at in (0, 1, 2)
    )
    tick = Tick(chunks)
    assert tick.large == {1, 2}
    assert tick.without(frozenset({1, 2})) is tick.without(frozenset({2, 1}))
    assert tick.without(frozenset({1, 2})).chunks == chunks[:1]
    assert tick.without(frozenset({7})) is tick
