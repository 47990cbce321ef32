"""A damaged chunk costs its own messages; a file that was changed meanwhile is no damaged one."""

from __future__ import annotations

import os
import tracemalloc
from typing import TYPE_CHECKING

import pytest
import zstandard

from studio.bags.opening import open_bag
from studio.errors import BagNotReadableError
from tests.support.bags import BEGIN_NS, Chunks, Told, string_cdr, write_mcap
from tests.support.damaged_bags import chunks_of, data_at, overwrite, put_crc, put_index, put_size
from tests.support.read_bags import all_of, as_read, read_bag

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from mcap.records import ChunkIndex

    Harm = Callable[[Path, ChunkIndex], None]

TOLD = [Told(f"/topic{n % 3}", n * 1_000_000, f"text {n}") for n in range(300)]
MEMORY_BYTES = 40_000_000
"""So little is taken to notice that a chunk claims more than it may."""


def _outside(chunk: ChunkIndex) -> list[tuple[str, int, bytes]]:
    """All messages but those of a chunk."""
    return [
        one
        for one in as_read(TOLD)
        if not chunk.message_start_time <= one[1] <= chunk.message_end_time
    ]


def _wrong_crc(file: Path, chunk: ChunkIndex) -> None:
    put_crc(file, chunk, 12345)


def _claims_a_terabyte(file: Path, chunk: ChunkIndex) -> None:
    put_size(file, chunk, 2**40)


def _claims_one_byte_less(file: Path, chunk: ChunkIndex) -> None:
    put_size(file, chunk, chunk.uncompressed_size - 1)


def _rubbish(file: Path, chunk: ChunkIndex) -> None:
    overwrite(file, data_at(chunk), b"rubbish" * (chunk.compressed_size // 7))


def _other_compression(file: Path, chunk: ChunkIndex) -> None:
    overwrite(file, data_at(chunk) - 12, b"bzip")


@pytest.mark.parametrize("chunks", [Chunks.ZSTD, Chunks.LZ4])
@pytest.mark.parametrize(
    ("harm", "said"),
    [
        (_wrong_crc, "its checksum is wrong"),
        (_claims_a_terabyte, "more than any part of a bag may"),
        (_claims_one_byte_less, "instead of"),
        (_rubbish, ""),
    ],
)
def test_a_damaged_chunk_costs_its_messages_and_is_told(
    tmp_path: Path, chunks: Chunks, harm: Harm, said: str
):
    file = write_mcap(tmp_path / "bag.mcap", TOLD, chunks=chunks)
    chunk = chunks_of(file)[5]
    harm(file, chunk)
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == _outside(chunk)
    (trouble,) = found.troubles
    assert "s are lost: in their chunk, " in trouble
    assert said in trouble


def test_a_chunk_in_an_unknown_compression_is_told(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    chunk = chunks_of(file)[5]
    _other_compression(file, chunk)
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == _outside(chunk)
    assert '"bzip", which is unknown here' in found.troubles[0]


def test_before_a_damaged_chunk_the_message_before_it_is_the_latest(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    chunk = chunks_of(file)[5]
    _wrong_crc(file, chunk)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    expected = max(one for one in as_read(TOLD)[::3] if one[1] < chunk.message_start_time)
    (latest,) = bag.latest(["/topic0"], chunk.message_end_time).values()
    assert ("/topic0", latest.received_ns, latest.payload) == expected
    bag.close()


def test_a_chunk_that_unpacks_to_more_than_it_says_takes_no_memory(tmp_path: Path):
    bomb = zstandard.compress(bytes(300_000_000))
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    chunks = chunks_of(file)
    long = next(one for one in chunks if one.compressed_size > 200)
    assert len(bomb) > long.compressed_size
    overwrite(file, data_at(long), bomb[: long.compressed_size])
    tracemalloc.start()
    try:
        found = read_bag(file, tmp_path / "kept")
        assert tracemalloc.get_traced_memory()[1] < MEMORY_BYTES
    finally:
        tracemalloc.stop()
    assert found.messages == _outside(long)
    assert "it would take 300000000 bytes instead of" in found.troubles[0]


def test_a_record_that_claims_a_file_of_any_size_is_not_read(tmp_path: Path):
    def change(number: int, chunk: ChunkIndex) -> None:
        if number == 5:
            chunk.chunk_length = 2**38

    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    chunk = chunks_of(file)[5]
    put_index(file, change, at=2**39)
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == _outside(chunk)
    assert f"a record has {2**38} bytes" in found.troubles[0]


def _grow(file: Path) -> None:
    with file.open("ab") as stream:
        stream.write(bytes(10_000))


def _replace(file: Path) -> None:
    write_mcap(file.with_name("other.mcap"), [Told("/other", 0)]).replace(file)


def _delete(file: Path) -> None:
    file.unlink()


@pytest.mark.parametrize("change", [_grow, _replace, _delete])
def test_what_is_left_of_an_open_file_is_read_on_and_its_change_is_seen(
    tmp_path: Path, change: Callable[[Path], None]
):
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    assert not bag.changed_on_disk()
    change(file)
    assert bag.changed_on_disk()
    assert all_of(bag) == as_read(TOLD)
    assert not bag.troubles
    bag.close()


def _truncate(file: Path) -> None:
    os.truncate(file, 2_000)


def _write_over(file: Path) -> None:
    file.write_bytes(bytes(range(256)) * 100)


@pytest.mark.parametrize("change", [_truncate, _write_over])
@pytest.mark.parametrize("ask", ["messages", "latest", "next_ns", "counts"])
def test_a_file_changed_in_place_is_said_to_be_and_not_to_be_damaged(
    tmp_path: Path, change: Callable[[Path], None], ask: str
):
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    change(file)
    assert bag.changed_on_disk()
    questions: dict[str, Callable[[], object]] = {
        "messages": lambda: all_of(bag),
        "latest": lambda: bag.latest(["/topic0"], BEGIN_NS + 200_000_000),
        "next_ns": lambda: bag.next_ns("/topic0", BEGIN_NS + 200_000_000),
        "counts": lambda: bag.counts("/topic0", 0, 2**62, 10),
    }
    with pytest.raises(BagNotReadableError, match="changed while it was open"):
        questions[ask]()
    assert not bag.troubles
    bag.close()


def test_messages_out_of_order_within_a_chunk_and_across_chunks_come_by_time(tmp_path: Path):
    shuffled = [Told("/t", n * 7919 % 500, str(n)) for n in range(500)]
    file = write_mcap(tmp_path / "bag.mcap", shuffled, chunk_bytes=600)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    assert all_of(bag) == sorted(as_read(shuffled), key=lambda one: one[1])
    parts = list(bag.columns("/t", BEGIN_NS + 100, BEGIN_NS + 200))
    stamps = [time for part in parts for time in part.times_ns.tolist()]
    assert sorted(stamps) == [BEGIN_NS + n for n in range(100, 200)]
    texts = [
        part.data[at : at + size]
        for part in parts
        for at, size in zip(part.offsets.tolist(), part.lengths.tolist(), strict=True)
    ]
    by_stamp = {BEGIN_NS + one.at_ns: string_cdr(one.text) for one in shuffled}
    assert texts == [by_stamp[stamp] for stamp in stamps]
    bag.close()
