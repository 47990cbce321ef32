"""What the studio writes, as the libraries of others and the studio itself read it."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from mcap.reader import make_reader
from rosbags.interfaces import MessageDefinitionFormat
from rosbags.rosbag2 import Reader

from studio.bags.mcap_writer import Chunking
from studio.bags.metadata import read_metadata
from studio.bags.writer import BagWriter, Storing
from studio.errors import BagNotWrittenError, SettingsError
from tests.support.written_bags import (
    BEGIN_NS,
    KINDS,
    LATCHED,
    TYPES,
    recorded_topic,
    sample,
    some_messages,
    told_by_mcap,
    told_by_rosbags,
    write,
)

if TYPE_CHECKING:
    from tests.support.written_bags import Told

MANNERS = {
    "mcap": Storing(),
    "mcap, zstd": Storing(chunking=Chunking(compression="zstd")),
    "mcap, zstd, small chunks": Storing(chunking=Chunking(2_000, "zstd", 19)),
    "mcap, lz4": Storing(chunking=Chunking(compression="lz4")),
    "mcap, no checksums": Storing(chunking=Chunking(with_crc=False)),
    "mcap, files": Storing(mode="file"),
    "mcap, split by size": Storing(max_bytes=300_000),
    "mcap, split by time": Storing(max_s=1.5),
    "mcap, split and files": Storing(mode="file", max_s=2.0, max_bytes=600_000),
    "sqlite3": Storing(storage="sqlite3"),
    "sqlite3, resilient": Storing(storage="sqlite3", resilient=True),
    "sqlite3, messages": Storing(storage="sqlite3", mode="message"),
    "sqlite3, files": Storing(storage="sqlite3", mode="file"),
    "sqlite3, split": Storing(storage="sqlite3", max_s=2.5),
}


@pytest.mark.parametrize("manner", MANNERS)
def test_b1_others_read_the_same_counts_stamps_and_bytes(tmp_path: Path, manner: str):
    told = some_messages()
    written = write(tmp_path / "bag", told, MANNERS[manner])
    assert written.messages == len(told)
    assert (written.begin_ns, written.end_ns) == (told[0][1], told[-1][1])
    assert told_by_rosbags(tmp_path / "bag") == told
    files = sorted((tmp_path / "bag").glob("*.mcap"), key=lambda one: int(one.stem.split("_")[1]))
    if files:
        assert [one for file in files for one in told_by_mcap(file)] == told
    if "split" in manner:
        assert len(list((tmp_path / "bag").iterdir())) > 3
    size = sum(one.stat().st_size for one in (tmp_path / "bag").iterdir())
    assert written.bytes == size - (tmp_path / "bag" / "metadata.yaml").stat().st_size


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_topics_keep_qos_hash_and_definition(tmp_path: Path, storage: str):
    write(tmp_path / "bag", some_messages(), MANNERS[storage])
    with Reader(tmp_path / "bag") as reader:
        found = {one.topic: one for one in reader.connections}
    assert found.keys() == KINDS.keys()
    image = found["/image"]
    assert image.msgtype == "sensor_msgs/msg/Image"
    assert image.digest == TYPES.hash_of("sensor_msgs/msg/Image")
    assert "=\nMSG: std_msgs/Header\n" in image.msgdef.data
    assert "=\nMSG: builtin_interfaces/Time\n" in image.msgdef.data
    about = read_metadata(tmp_path / "bag" / "metadata.yaml")
    (description,) = (one for one in about.topics if one.name == "/description")
    assert description.qos == (LATCHED,)
    strange = found["/strange"]
    assert (strange.msgdef.format, strange.msgdef.data) == (MessageDefinitionFormat.NONE, "")
    assert (found["/words"].msgcount, found["/description"].msgcount) == (200, 0)


def test_an_mcap_is_of_the_profile_of_ros2_with_number_and_time_of_publishing(tmp_path: Path):
    write(tmp_path / "bag", some_messages(10))
    with (tmp_path / "bag" / "bag_0.mcap").open("rb") as stream:
        reader = make_reader(stream)
        assert reader.get_header().profile == "ros2"
        assert [(one.name, "message_count: 10" in one.metadata["serialized_metadata"])
                for one in reader.iter_metadata()] == [("rosbag2", True)]  # fmt: skip
        for place, (schema, channel, message) in enumerate(reader.iter_messages()):
            assert (message.sequence, message.publish_time) == (place, message.log_time - 1_000)
            assert channel.message_encoding == "cdr"
            assert channel.metadata.keys() == {"offered_qos_profiles", "topic_type_hash"}
            assert schema is not None
            assert schema.encoding == ("" if schema.name == KINDS["/strange"] else "ros2msg")


@given(
    st.lists(
        st.tuples(
            st.sampled_from(sorted(KINDS)),
            st.integers(0, 2**62),
            st.binary(max_size=300),
        ),
        max_size=60,
    ),
    st.sampled_from(["", "zstd", "lz4"]),
    st.integers(1, 2_000),
)
def test_whatever_comes_in_whatever_order_of_times_is_kept(
    drawn: list[Told], compression: str, chunk_bytes: int
):
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "bag"
        chunking = Chunking(chunk_bytes, compression)  # pyright: ignore[reportArgumentType]
        written = write(bag, drawn, Storing(chunking=chunking))
        assert written.messages == len(drawn)
        by_time = sorted(drawn, key=lambda one: one[1])
        assert sorted(told_by_mcap(bag / "bag_0.mcap")) == sorted(drawn)
        assert [one[1] for one in told_by_rosbags(bag)] == [one[1] for one in by_time]


def test_an_empty_bag_and_one_that_is_open_can_be_looked_into(tmp_path: Path):
    writer = BagWriter(tmp_path / "bag", TYPES)
    about = yaml.safe_load((tmp_path / "bag" / "metadata.yaml").read_text())
    assert about["rosbag2_bagfile_information"]["relative_file_paths"] == ["bag_0.mcap"]
    assert writer.close().messages == 0
    assert told_by_rosbags(tmp_path / "bag") == []
    with pytest.raises(BagNotWrittenError, match="closed"):
        writer.add_topic(recorded_topic("/words"))


def test_each_file_is_whole_as_soon_as_the_next_begins(tmp_path: Path):
    writer = BagWriter(tmp_path / "bag", TYPES)
    number = writer.add_topic(recorded_topic("/words"))
    for place in range(3):
        writer.write(number, sample(BEGIN_NS + place, b"one"))
        writer.split()
        assert told_by_mcap(tmp_path / "bag" / f"bag_{place}.mcap") == [
            ("/words", BEGIN_NS + place, b"one")
        ]
    assert writer.close().messages == 3


def test_the_oldest_files_are_removed_and_counted_no_more(tmp_path: Path):
    writer = BagWriter(tmp_path / "bag", TYPES, Storing(max_s=1.0, max_files=2))
    number = writer.add_topic(recorded_topic("/words"))
    for place in range(10):
        writer.write(number, sample(BEGIN_NS + place * 1_000_000_000, b"one"))
    assert writer.close().messages == 2
    assert writer.taken(number) == 10
    assert len(told_by_rosbags(tmp_path / "bag")) == 2


@pytest.mark.parametrize(
    ("storing", "said"),
    [
        (Storing(max_bytes=1_000), "1024 bytes or more"),
        (Storing(storage="sqlite3", max_bytes=80_000), "86016 bytes or more"),
        (Storing(mode="message"), "zstd_fast"),
        (Storing(max_files=2), "--max-bag-size"),
    ],
)
def test_what_does_not_go_together_is_refused(tmp_path: Path, storing: Storing, said: str):
    with pytest.raises(SettingsError, match=said):
        BagWriter(tmp_path / "bag", TYPES, storing)
    assert not (tmp_path / "bag").exists()
