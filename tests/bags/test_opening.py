"""Opening bags: what the libraries wrote, whole and damaged, is read with nothing else lost."""

from __future__ import annotations

import shutil
import struct
from typing import TYPE_CHECKING

import pytest
from mcap.writer import IndexType

from studio.bags.opening import open_bag
from studio.bags.writer import STORAGES, Storing
from studio.errors import BagNotReadableError
from tests.bags.test_writer import MANNERS
from tests.support.bags import BEGIN_NS, Chunks, Told, string_cdr, write_mcap
from tests.support.permissions import open_folder, unprivileged
from tests.support.read_bags import as_read, read_bag
from tests.support.written_bags import some_messages, told_by_mcap, write

if TYPE_CHECKING:
    from pathlib import Path

    from studio.bags.writer import Storage

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


@pytest.mark.parametrize("encoding", ["ros1", "json", "protobuf"])
def test_messages_in_another_encoding_are_listed_and_left(tmp_path: Path, encoding: str):
    file = write_mcap(tmp_path / "bag.mcap", MESSAGES[:30], encoding=encoding)
    found = read_bag(file, tmp_path / "kept")
    assert [(one.encoding, one.count) for one in found.topics.values()] == [(encoding, 10)] * 3
    for topic in found.topics.values():
        assert (
            topic.trouble == f'Its messages are in the form "{encoding}", which is not read here.'
        )


def test_a_topic_of_two_types_is_that_of_most_messages(tmp_path: Path):
    others = [Told("/topic0", 50 + n, str(n), "o_msgs/msg/O") for n in range(3)]
    schemas = {"o_msgs/msg/O": "int32 a\n"}
    file = write_mcap(tmp_path / "bag.mcap", [*MESSAGES[:30], *others], schemas=schemas)
    found = read_bag(file, tmp_path / "kept")
    assert found.messages == as_read(MESSAGES[:30])
    topic = found.topics["/topic0"]
    assert (topic.type_name, topic.count) == ("std_msgs/msg/String", 10)
    assert topic.note == "3 messages of other types are left out: o_msgs/msg/O."
    assert not found.topics["/topic1"].note


def _split(folder: Path) -> list[Path]:
    write(folder / "bag", some_messages(), Storing(max_s=0.5))
    return [folder / "bag" / f"bag_{number}.mcap" for number in range(12)]


def test_a_split_bag_without_one_of_its_files_has_the_others(tmp_path: Path):
    files = _split(tmp_path)
    gone = told_by_mcap(files[4])
    files[4].unlink()
    found = read_bag(tmp_path / "bag", tmp_path / "kept")
    assert found.messages == [one for one in some_messages() if one not in gone]
    assert found.troubles == ["bag_4.mcap: named in metadata.yaml, and not there."]


def test_a_split_bag_of_which_one_file_is_rubbish_has_the_others(tmp_path: Path):
    files = _split(tmp_path)
    gone = told_by_mcap(files[4])
    files[4].write_bytes(b"rubbish" * 1_000)
    found = read_bag(tmp_path / "bag", tmp_path / "kept")
    assert found.messages == [one for one in some_messages() if one not in gone]
    assert found.troubles == ["bag_4.mcap is left out: nothing in it is whole."]


def test_files_without_metadata_are_taken_in_the_order_of_their_numbers(tmp_path: Path):
    files = _split(tmp_path)
    (tmp_path / "bag" / "metadata.yaml").unlink()
    bag = open_bag(tmp_path / "bag", kept_in=tmp_path / "kept")
    assert list(bag.files) == files
    bag.close()
    assert read_bag(tmp_path / "bag", tmp_path / "kept").messages == some_messages()


@pytest.mark.parametrize("storage", STORAGES)
def test_a_bag_is_opened_by_its_folder_its_metadata_or_its_file(tmp_path: Path, storage: Storage):
    written = write(tmp_path / "bag", some_messages(), Storing(storage=storage))
    (file,) = (one for one in written.path.iterdir() if one.name != "metadata.yaml")
    for path in (written.path, written.path / "metadata.yaml", file):
        found = read_bag(path, tmp_path / "kept")
        assert found.messages == some_messages()
        assert not found.troubles


def test_what_is_no_bag_is_refused_with_a_sentence(tmp_path: Path):
    (tmp_path / "text.txt").write_text("a text")
    (tmp_path / "empty.mcap").touch()
    (tmp_path / "folder").mkdir()
    (tmp_path / "bag.mcap").mkdir()
    for name, said in (
        ("text.txt", "a bag is a folder, or a file named"),
        ("empty.mcap", "nothing in it is whole"),
        ("folder", "it holds no file of a bag"),
        ("bag.mcap", "it holds no file of a bag"),
        ("nothing.mcap", "it is not there"),
    ):
        with pytest.raises(BagNotReadableError, match=said):
            open_bag(tmp_path / name, kept_in=tmp_path / "kept")


def test_a_folder_or_a_file_that_may_not_be_read_is_refused_with_a_sentence():
    with open_folder() as folder:
        for storage in STORAGES:
            written = write(folder / storage, some_messages(9), Storing(storage=storage))
            (file,) = (one for one in written.path.iterdir() if one.name != "metadata.yaml")
            for path in (file, written.path):
                path.chmod(0)
                with unprivileged(), pytest.raises(BagNotReadableError, match=storage):
                    open_bag(written.path, kept_in=folder / "kept")
            written.path.chmod(0o755)


def test_without_metadata_a_db3_says_what_it_was_recorded_with(tmp_path: Path):
    write(tmp_path / "bag", some_messages(9), Storing(storage="sqlite3"))
    (tmp_path / "bag" / "metadata.yaml").unlink()
    bag = open_bag(tmp_path / "bag", kept_in=tmp_path / "kept")
    assert bag.distro == "jazzy"
    bag.close()
