"""Files without an index: all that is whole in them is found, and what is not is told."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer

from studio.bags.compression import PART_BYTES_MAX
from studio.bags.opening import open_bag
from tests.support.bags import BEGIN_NS, STRING, Chunks, Told, string_cdr, write_mcap
from tests.support.damaged_bags import chunks_of, data_at, overwrite
from tests.support.read_bags import as_read, read_bag
from tests.support.written_bags import kept_in_mcap

if TYPE_CHECKING:
    from pathlib import Path

TOLD = [Told(f"/topic{n % 3}", n * 1_000_000, f"text {n}") for n in range(300)]


@pytest.mark.parametrize("compression", CompressionType)
def test_a_recording_that_was_killed_has_all_but_its_last_chunk(
    tmp_path: Path, compression: CompressionType
):
    file = tmp_path / "bag.mcap"
    with file.open("wb") as stream:
        writer = Writer(stream, chunk_size=1_000, compression=compression)
        writer.start("ros2", "tests")
        kind = writer.register_schema("std_msgs/msg/String", "ros2msg", STRING.encode())
        channel = writer.register_channel("/t", "cdr", kind)
        for number in range(300):
            at_ns = BEGIN_NS + number
            writer.add_message(channel, at_ns, string_cdr(str(number)), at_ns)
    found = read_bag(file, tmp_path / "kept")
    assert [payload for _, _, payload in found.messages] == kept_in_mcap(file)
    assert 270 < len(found.messages) < 300
    assert found.topics["/t"].count == len(found.messages)
    assert found.topics["/t"].type_name == "std_msgs/msg/String"
    assert "it was not closed, so that it has no index" in found.troubles[0]


def test_messages_in_no_chunk_are_found_around_rubbish(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD, chunked=False)
    places = [file.read_bytes().index(string_cdr(f"text {n}")) - 31 for n in (150, 153)]
    overwrite(file, places[0], b"\xee" * (places[1] - places[0]))
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == as_read(
        [one for one in TOLD if one.text[5:] not in {"150", "151", "152"}]
    )
    assert any(f"{places[1] - places[0]} bytes are rubbish" in one for one in found.troubles)


def test_a_chunk_overwritten_in_a_file_without_index_costs_its_messages(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    chunks, whole = chunks_of(file), file.read_bytes()
    lost = chunks[6]
    file.write_bytes(whole[: chunks[-1].chunk_start_offset + 30])
    end = lost.chunk_start_offset + lost.chunk_length + lost.message_index_length
    overwrite(file, lost.chunk_start_offset, b"\xee" * (end - lost.chunk_start_offset))
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == [
        one
        for one in as_read(TOLD)
        if one[1] < chunks[-1].message_start_time
        and not lost.message_start_time <= one[1] <= lost.message_end_time
    ]


def test_the_first_messages_of_a_chunk_that_is_cut_off_are_kept(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD, chunks=Chunks.NONE, chunk_bytes=10**6)
    (chunk,) = chunks_of(file)
    file.write_bytes(file.read_bytes()[: data_at(chunk) + chunk.compressed_size // 2])
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == as_read(TOLD)[: len(found.messages)]
    assert 140 < len(found.messages) < 160


def test_a_message_that_claims_more_than_it_may_is_passed_over(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD, chunked=False)
    at = file.read_bytes().index(string_cdr("text 150")) - 31
    overwrite(file, at + 1, struct.pack("<Q", PART_BYTES_MAX + 1))
    with file.open("r+b") as stream:
        stream.truncate(2 * PART_BYTES_MAX)  # takes no room on the disk
    found = read_bag(file, tmp_path / "kept")
    assert found.messages[:150] == as_read(TOLD)[:150]
    assert set(found.messages) <= set(as_read(TOLD))


def test_progress_goes_from_nothing_to_all_while_an_index_is_made(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD * 20, index=IndexType.NONE, chunk_bytes=300)
    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is None or not summary.chunk_indexes
    told: list[float] = []
    open_bag(file, told.append, kept_in=tmp_path / "kept").close()
    assert told == sorted(told)
    assert len(told) > 50
    assert 0 < told[0] < 0.1
    assert 0.9 < told[-1] <= 1
