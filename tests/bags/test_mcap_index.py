"""An index that lies: the file is read by its data instead, whatever the index says."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from mcap.writer import Writer

from studio.bags.opening import open_bag
from tests.support.bags import BEGIN_NS, STRING, Chunks, Told, string_cdr, write_mcap
from tests.support.damaged_bags import chunks_of, cut_out, overwrite, put_index
from tests.support.read_bags import as_read, read_bag

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from mcap.records import ChunkIndex

    Change = Callable[[int, ChunkIndex], None]

TOLD = [Told(f"/topic{n % 3}", n * 1_000_000, f"text {n}") for n in range(300)]
FAR = 2**62


def _behind_the_end(number: int, chunk: ChunkIndex) -> None:
    chunk.chunk_start_offset += 10_000_000 * (number == 3)


def _at_zero(number: int, chunk: ChunkIndex) -> None:
    chunk.chunk_start_offset *= number != 3


def _without_length(_number: int, chunk: ChunkIndex) -> None:
    chunk.chunk_length = FAR


def _sums_that_wrap(number: int, chunk: ChunkIndex) -> None:
    if number == 3:
        chunk.chunk_start_offset = chunk.chunk_length = 2**63 - 1
        chunk.message_index_length = 102  # 100 in 64 bits, with the two


def _channels_unknown(_number: int, chunk: ChunkIndex) -> None:
    chunk.message_index_offsets = {99: 100}


def _nothing_inside(_number: int, chunk: ChunkIndex) -> None:
    chunk.message_index_offsets = {}


@pytest.mark.parametrize(
    "change",
    [
        _behind_the_end,
        _at_zero,
        _without_length,
        _sums_that_wrap,
        _channels_unknown,
        _nothing_inside,
    ],
)
def test_an_index_that_points_nowhere_is_made_anew(tmp_path: Path, change: Change):
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    put_index(file, change)
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == as_read(TOLD)
    assert "its index was made anew, with 300 messages" in found.troubles[0]


def test_an_index_of_zero_bytes_is_made_anew(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    size, last = file.stat().st_size, chunks_of(file)[-1]
    behind = last.chunk_start_offset + last.chunk_length + last.message_index_length
    overwrite(file, behind + 13, bytes(size - behind - 13 - 37))
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == as_read(TOLD)
    assert "its index" in found.troubles[0]


def test_message_indexes_that_point_elsewhere_cost_nothing(tmp_path: Path):
    def change(_number: int, chunk: ChunkIndex) -> None:
        chunk.message_index_offsets = {
            key: at + 7 for key, at in chunk.message_index_offsets.items()
        }

    file = write_mcap(tmp_path / "bag.mcap", TOLD)
    put_index(file, change)
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == as_read(TOLD)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    assert bag.latest(["/topic1"], BEGIN_NS + 200_000_000)["/topic1"].payload == string_cdr(
        "text 199"
    )
    bag.close()


def test_data_cut_out_of_a_file_costs_only_itself(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", TOLD, chunks=Chunks.NONE)
    chunks = chunks_of(file)
    inside = sum(
        chunks[4].message_start_time <= BEGIN_NS + one.at_ns <= chunks[5].message_end_time
        for one in TOLD
    )
    cut_out(file, chunks[4].chunk_start_offset + 300, chunks[5].chunk_start_offset + 300)
    found = read_bag(file, tmp_path / "kept")
    assert found.troubles
    assert set(found.messages) <= set(as_read(TOLD))
    assert len(TOLD) - inside <= len(found.messages) < len(TOLD)


def test_messages_are_counted_where_the_file_does_not(tmp_path: Path):
    with (tmp_path / "bag.mcap").open("wb") as stream:
        writer = Writer(stream, use_statistics=False)
        writer.start("ros2", "tests")
        kind = writer.register_schema("std_msgs/msg/String", "ros2msg", STRING.encode())
        channel = writer.register_channel("/a", "cdr", kind)
        for number in range(7):
            writer.add_message(channel, BEGIN_NS + number, string_cdr("a"), BEGIN_NS)
        writer.finish()
    found = read_bag(tmp_path / "bag.mcap", tmp_path / "kept")
    assert (found.topics["/a"].count, len(found.messages)) == (7, 7)


def test_topics_without_messages_or_without_a_name_are_listed(tmp_path: Path):
    with (tmp_path / "bag.mcap").open("wb") as stream:
        writer = Writer(stream, chunk_size=10)
        writer.start("ros2", "tests")
        kind = writer.register_schema("std_msgs/msg/String", "ros2msg", STRING.encode())
        nameless = writer.register_channel("", "cdr", kind)
        writer.add_message(nameless, BEGIN_NS + 5, string_cdr("a"), BEGIN_NS)
        writer.register_channel("/silent", "cdr", kind)
        writer.finish()
    found = read_bag(tmp_path / "bag.mcap", tmp_path / "kept")
    assert {name: one.count for name, one in found.topics.items()} == {"": 1, "/silent": 0}
    assert found.messages == [("", BEGIN_NS + 5, string_cdr("a"))]
    assert (found.begin_ns, found.end_ns) == (BEGIN_NS + 5, BEGIN_NS + 5)
    bag = open_bag(tmp_path / "bag.mcap")
    assert bag.last("/silent", 2**62, 5) == []
    assert bag.next_ns("/silent", 0) is None
    assert bag.counts("/silent", 0, 100, 4).tolist() == [0] * 4
    bag.close()
