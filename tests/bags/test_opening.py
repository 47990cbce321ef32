"""Opening bags: what the libraries wrote, whole and damaged, is read with nothing else lost."""

from __future__ import annotations

import shutil
import struct
from typing import TYPE_CHECKING

import pytest
from mcap.writer import IndexType

from studio.bags.opening import open_bag
from studio.errors import BagNotReadableError
from tests.bags.test_writer import MANNERS
from tests.support.bags import BEGIN_NS, Chunks, Told, string_cdr, write_mcap
from tests.support.read_bags import as_read, read_bag
from tests.support.written_bags import some_messages, write

if TYPE_CHECKING:
    from pathlib import Path

MESSAGES = [
    Told(f"/topic{number % 3}", number * 1_000_000, f"text {number}") for number in range(400)
]


@pytest.mark.parametrize("chunks", Chunks)
@pytest.mark.parametrize("index", [IndexType.ALL, IndexType.NONE])
def test_what_mcap_wrote_is_read_whole(tmp_path: Path, chunks: Chunks, index: IndexType):
    file = write_mcap(tmp_path / "bag.mcap", MESSAGES, chunks=chunks, index=index)
    read, *_ = read_bag(file, tmp_path / "kept")
    assert read == as_read(MESSAGES)


@pytest.mark.parametrize("manner", MANNERS)
def test_what_the_studio_wrote_is_read_equal_in_every_storage(tmp_path: Path, manner: str):
    told = some_messages()
    write(tmp_path / "bag", told, MANNERS[manner])
    read, troubles, *_ = read_bag(tmp_path / "bag", tmp_path / "kept")
    assert sorted(read) == sorted(told)
    assert not troubles


@pytest.mark.parametrize("chunked", [True, False])
@pytest.mark.parametrize("tenth", range(1, 10))
def test_an_mcap_cut_off_at_a_tenth_keeps_what_came_before(
    tmp_path: Path, tenth: int, *, chunked: bool
):
    file = write_mcap(tmp_path / "bag.mcap", MESSAGES, chunked=chunked, chunks=Chunks.NONE)
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) * tenth // 10])
    read, troubles, *_ = read_bag(file, tmp_path / "kept")
    assert troubles
    assert read == as_read(MESSAGES)[: len(read)]
    kept_whole = [one for one in MESSAGES if string_cdr(one.text) in file.read_bytes()]
    assert len(kept_whole) - 40 <= len(read) <= len(kept_whole)  # a chunk has fewer than 40


@pytest.mark.parametrize("tenth", range(1, 10))
def test_a_db3_cut_off_at_a_tenth_is_read_in_part_or_refused_with_a_sentence(
    tmp_path: Path, tenth: int
):
    manner = MANNERS["sqlite3"]
    told = some_messages()
    write(tmp_path / "bag", told, manner)
    (file,) = (tmp_path / "bag").glob("*.db3")
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) * tenth // 10])
    try:
        read, troubles, *_ = read_bag(tmp_path / "bag", tmp_path / "kept")
    except BagNotReadableError as error:
        read, troubles = [], [str(error)]
    assert any(file.name in one for one in troubles)
    assert set(read) < set(told)


def test_a_chunk_of_rubbish_costs_its_messages_alone(tmp_path: Path):
    file = write_mcap(tmp_path / "bag.mcap", MESSAGES, chunks=Chunks.ZSTD)
    data = bytearray(file.read_bytes())
    place = data.index(struct.pack("<I", 4) + b"zstd", len(data) // 3)
    data[place + 40 : place + 80] = bytes(40)
    file.write_bytes(data)
    read, troubles, *_ = read_bag(file, tmp_path / "kept")
    assert any(troubles)
    assert set(read) < set(as_read(MESSAGES))
    assert len(MESSAGES) - 60 <= len(read) < len(MESSAGES)


def test_stamps_that_go_back_are_read_in_order_of_time(tmp_path: Path):
    backwards = [Told("/t", (1_000 - number) * 1_000, str(number)) for number in range(300)]
    file = write_mcap(tmp_path / "bag.mcap", backwards)
    read, *_ = read_bag(file, tmp_path / "kept")
    assert read == sorted(as_read(backwards), key=lambda one: one[1])


def test_ten_thousand_topics_are_listed_and_read(tmp_path: Path):
    many = [Told(f"/t{number:05}", number, "x") for number in range(10_000)]
    file = write_mcap(tmp_path / "bag.mcap", many, chunk_bytes=100_000)
    bag = open_bag(file, kept_in=tmp_path / "kept")
    try:
        names = [topic.name for topic in bag.topics]
        assert names == [one.topic for one in many]
        assert len(bag.latest(names, BEGIN_NS + 5_000)) == 5_001
    finally:
        bag.close()


def test_a_folder_without_its_metadata_opens_and_says_so(tmp_path: Path):
    told = some_messages()
    write(tmp_path / "bag", told)
    (tmp_path / "bag" / "metadata.yaml").unlink()
    read, troubles, *_ = read_bag(tmp_path / "bag", tmp_path / "kept")
    assert len(read) == len(told)
    assert any("metadata.yaml is missing" in one for one in troubles)
    shutil.rmtree(tmp_path / "bag")
    with pytest.raises(BagNotReadableError, match="not there"):
        open_bag(tmp_path / "bag")
