"""The messages of blocks that touch or overlap in time come by their times, and all of them."""

from __future__ import annotations

import random
from contextlib import closing
from typing import TYPE_CHECKING

import pytest

from studio.bags.opening import open_bag
from tests.support.bags import BEGIN_NS, Told, string_cdr, write_mcap

if TYPE_CHECKING:
    from pathlib import Path

_LARGE = "x" * 2**20
_Message = tuple[int, str, bytes]


def _read(file: Path, span_ns: tuple[int, int] = (0, 2**62)) -> list[_Message]:
    with closing(open_bag(file, kept_in=file.parent / "kept")) as bag:
        topics = [one.name for one in bag.topics]
        return [
            (sample.received_ns - BEGIN_NS, topic, sample.payload)
            for topic, sample in bag.messages(topics, *span_ns)
        ]


def _by_time(told: list[Told]) -> list[_Message]:
    """Sort what was written by time, and what has one time as it was written."""
    return sorted(
        ((one.at_ns, one.topic, string_cdr(one.text)) for one in told), key=lambda one: one[0]
    )


def test_messages_of_one_time_in_two_chunks_come_as_they_were_written(tmp_path: Path):
    told = [Told(f"/t{number % 7}", number // 60, str(number)) for number in range(900)]
    assert _read(write_mcap(tmp_path / "bag.mcap", told)) == _by_time(told)


def test_of_chunks_with_one_time_the_one_that_lies_first_comes_first(tmp_path: Path):
    later_first = [Told("/a", 5, "first"), Told("/b", 9), Told("/b", 1), Told("/b", 5, "second")]
    file = write_mcap(tmp_path / "bag.mcap", later_first, chunk_bytes=60)
    assert _read(file) == _by_time(later_first)


@pytest.mark.parametrize("spread", [3, 30, 300, 3_000])
def test_messages_that_came_out_of_order_are_read_by_their_times(tmp_path: Path, spread: int):
    hand = random.Random(spread)
    times = [number + hand.randrange(spread) for number in range(0, 8_000, 4)]
    told = [Told(f"/t{hand.randrange(5)}", at, str(number)) for number, at in enumerate(times)]
    file = write_mcap(tmp_path / "bag.mcap", told)
    whole = _by_time(told)
    assert _read(file) == whole
    part = [one for one in whole if 1_000 <= one[0] < 6_000]
    assert _read(file, (BEGIN_NS + 1_000, BEGIN_NS + 6_000)) == part


def test_more_than_is_held_of_chunks_that_overlap_is_read_whole(tmp_path: Path):
    told: list[Told] = []
    for number in range(40):
        told += [Told("/small", number), Told("/large", 1_000 - number, f"{number}{_LARGE}")]
    file = write_mcap(tmp_path / "bag.mcap", told, chunk_bytes=2**20)
    assert _read(file) == _by_time(told)
