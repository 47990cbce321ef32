from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import RelayLineError
from studio.live.topics.frames import Chunk, chunk_of, frame_of
from studio.server.relays.topic_frames import chunks_of_frame, with_lost
from tests.live.topics.test_frames import samples
from tests.support.hearers import read_frame


def chunk(channel: int, payloads: list[bytes], lost: int) -> Chunk:
    return chunk_of(channel, samples(payloads), lost, keeps_all=True)


CHUNKS = st.lists(
    st.builds(
        chunk,
        st.integers(0, 3),
        st.lists(st.binary(max_size=40), max_size=4),
        st.integers(0, 2**32 - 1),
    ),
    max_size=6,
)
ALL = dict.fromkeys(range(4), True)


@given(CHUNKS)
def test_a_frame_is_parted_by_channel_without_a_byte_of_another_kind(chunks: list[Chunk]):
    parted = chunks_of_frame(frame_of(chunks, 5), ALL)
    for channel in ALL:
        ours = [one for one in chunks if one.channel == channel and one.count]
        assert (channel in parted) == bool(ours)
        if ours:
            assert read_frame(frame_of([parted[channel]], 0)) == read_frame(frame_of(ours, 0))


def test_what_is_of_no_known_channel_is_left_out():
    chunks = [chunk_of(at, samples([b"x"]), 0, keeps_all=False) for at in (1, 2)]
    (only,) = chunks_of_frame(frame_of(chunks, 0), {2: False}).values()
    assert (only.channel, only.count, only.keeps_all) == (2, 1, False)


@given(CHUNKS.filter(bool), st.integers(0, 2**33))
def test_what_a_line_lost_is_added_in_each_message(chunks: list[Chunk], more: int):
    before = read_frame(frame_of(chunks, 0))[1]
    after = read_frame(frame_of([with_lost(one, more) for one in chunks], 0))[1]
    assert after == [one._replace(lost=(one.lost + more) % 2**32) for one in before]


@given(CHUNKS, st.data())
def test_a_frame_that_was_cut_is_told_from_a_whole_one(chunks: list[Chunk], data: st.DataObject):
    whole = frame_of(chunks, 0)
    cut = whole[: data.draw(st.integers(0, len(whole) - 1))]
    for one in (cut, whole + bytes(8)):
        with pytest.raises(RelayLineError):
            chunks_of_frame(one, ALL)
