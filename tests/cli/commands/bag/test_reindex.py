from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from rosbags.rosbag2 import Reader

from studio.bags.mcap_writer import Chunking
from studio.bags.metadata import read_metadata
from studio.bags.writer import Storing
from tests.support.command_line import studio
from tests.support.written_bags import some_messages, told_by_rosbags, write

if TYPE_CHECKING:
    from pathlib import Path

STORINGS = {
    "mcap": Storing(),
    "mcap_zstd": Storing(chunking=Chunking(compression="zstd")),
    "sqlite3": Storing(storage="sqlite3"),
    "split": Storing(max_bytes=400_000),
    "file": Storing(mode="file"),
    "message": Storing(storage="sqlite3", mode="message"),
}


@pytest.mark.parametrize("name", STORINGS)
def test_lost_metadata_is_written_as_it_was(name: str, tmp_path: Path):
    write(tmp_path / "bag", some_messages(), STORINGS[name])
    file = tmp_path / "bag" / "metadata.yaml"
    before, told = read_metadata(file), told_by_rosbags(tmp_path / "bag")
    file.unlink()
    ran = studio("bag", "reindex", str(tmp_path / "bag"))
    assert ran.code == 0, ran.err
    assert f"{len(told)} messages in {len(before.files)} file" in ran.out
    after = read_metadata(file)
    assert after.files == before.files
    assert (after.begin_ns, after.duration_ns) == (before.begin_ns, before.duration_ns)
    assert after.compression_mode == before.compression_mode
    topics = {one.name: one for one in after.topics}
    assert topics == {one.name: one for one in before.topics}
    assert told_by_rosbags(tmp_path / "bag") == told


def test_a_file_that_metadata_does_not_name_is_taken_in(tmp_path: Path):
    write(tmp_path / "bag", some_messages(), Storing(max_bytes=400_000))
    file = tmp_path / "bag" / "metadata.yaml"
    first, *others = read_metadata(file).files
    assert others
    text = file.read_text()
    for name in others:
        text = text.replace(f"  - {name}\n", "")
    file.write_text(text)
    assert read_metadata(file).files == (first,)
    assert studio("bag", "reindex", str(tmp_path / "bag")).code == 0
    assert read_metadata(file).files == (first, *others)
    assert read_metadata(file).distro == "jazzy"  # what files do not say stays


def test_of_a_file_that_was_cut_off_what_is_whole_is_counted(tmp_path: Path):
    write(tmp_path / "bag", some_messages())
    (mcap,) = (tmp_path / "bag").glob("*.mcap")
    mcap.write_bytes(mcap.read_bytes()[: mcap.stat().st_size // 2])
    ran = studio("bag", "reindex", str(tmp_path / "bag"))
    assert ran.code == 0
    assert "WARNING: bag_0.mcap: " in ran.err
    assert f"studio bag cut {tmp_path / 'bag'} NEW_FOLDER" in ran.out
    count = read_metadata(tmp_path / "bag" / "metadata.yaml").count
    assert 0 < count < len(some_messages())
    copy = tmp_path / "whole"
    assert studio("bag", "cut", str(tmp_path / "bag"), str(copy)).code == 0
    with Reader(copy) as reader:
        assert reader.message_count == count


@pytest.mark.parametrize(
    ("words", "said"),
    [(("bag_0.mcap",), "metadata stands in the folder"), ((".", "-s", "sqlite3"), "are of mcap")],
)
def test_what_cannot_be_told_leaves_metadata_as_it_is(
    words: tuple[str, ...], said: str, tmp_path: Path
):
    write(tmp_path / "bag", some_messages())
    before = (tmp_path / "bag" / "metadata.yaml").read_bytes()
    ran = studio("bag", "reindex", str(tmp_path / "bag" / words[0]), *words[1:])
    assert ran.code == 2
    assert said in ran.err
    assert (tmp_path / "bag" / "metadata.yaml").read_bytes() == before
