"""`metadata.yaml` of every release, QoS as numbers and as words, and what is no metadata."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from rosbags.rosbag2.metadata import parse_qos

from studio.bags.metadata import METADATA_BYTES_MAX, metadata_of, profiles_of, read_metadata
from studio.bags.opening import open_bag
from studio.errors import BagNotReadableError
from studio.ros.duration import Duration
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from tests.support.patience import Stopwatch
from tests.support.read_bags import read_bag
from tests.support.written_bags import some_messages, write

if TYPE_CHECKING:
    from pathlib import Path

HUMBLE_QOS = """\
- history: 1
  depth: 7
  reliability: 2
  durability: 1
  deadline: {sec: 2147483647, nsec: 4294967295}
  lifespan: {sec: 1, nsec: 500000000}
  liveliness: 1
  liveliness_lease_duration: {sec: 9223372036, nsec: 854775807}
  avoid_ros_namespace_conventions: false
"""
JAZZY_QOS = (
    HUMBLE_QOS.replace("history: 1", "history: keep_last")
    .replace("reliability: 2", "reliability: best_effort")
    .replace("durability: 1", "durability: transient_local")
    .replace("liveliness: 1", "liveliness: automatic")
)
PROFILE = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=7,
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    lifespan=Duration(seconds=1.5),
    liveliness=LivelinessPolicy.AUTOMATIC,
)
HASH = "RIHS01_" + "ab" * 32


def metadata_text(version: int, files: list[str], storage: str = "mcap") -> str:
    """What a recorder of that version writes: what is newer is not in it."""
    topic: dict[str, object] = {
        "name": "/words",
        "type": "std_msgs/msg/String",
        "serialization_format": "cdr",
    }
    about: dict[str, object] = {
        "version": version,
        "storage_identifier": storage,
        "relative_file_paths": [f"bag/{one}" for one in files] if version < 3 else files,
        "duration": {"nanoseconds": 5_990_000_000},
        "starting_time": {"nanoseconds_since_epoch": 1_700_000_000_000_000_000},
        "message_count": 600,
        "topics_with_message_count": [{"topic_metadata": topic, "message_count": 200}],
    }
    if version >= 3:
        about |= {"compression_format": "", "compression_mode": ""}
    if version >= 4:
        topic["offered_qos_profiles"] = HUMBLE_QOS if version < 9 else yaml.safe_load(JAZZY_QOS)
    if version >= 5:
        about["files"] = [{"path": one, "message_count": 600} for one in files]
    if version >= 6:
        about["custom_data"] = {"robot": "rover"} if version > 6 else None
    if version >= 7:
        topic["type_description_hash"] = HASH
    if version >= 8:
        about["ros_distro"] = "iron" if version == 8 else "rolling"
    return yaml.safe_dump({"rosbag2_bagfile_information": about})


@pytest.mark.parametrize("version", range(1, 10))
def test_a_bag_of_every_version_is_opened_by_what_it_says(tmp_path: Path, version: int):
    told = some_messages()
    write(tmp_path / "bag", told)
    text = metadata_text(version, ["bag_0.mcap"])
    (tmp_path / "bag" / "metadata.yaml").write_text(text)
    about = read_metadata(tmp_path / "bag" / "metadata.yaml")
    (topic,) = about.topics
    assert (topic.name, topic.type_name, topic.count) == ("/words", "std_msgs/msg/String", 200)
    assert topic.qos == ((PROFILE,) if version >= 4 else ())
    assert topic.type_hash == (HASH if version >= 7 else "")
    assert about.distro == {8: "iron", 9: "rolling"}.get(version, "")
    assert about.custom_data == ({"robot": "rover"} if version > 6 else {})
    assert (about.begin_ns, about.duration_ns) == (told[0][1], told[-1][1] - told[0][1])
    found = read_bag(tmp_path / "bag", tmp_path / "kept")
    assert found.messages == told
    assert not found.troubles


POLICY = st.one_of(
    st.integers(-1, 9),
    st.sampled_from(["keep_last", "keep_all", "reliable", "best_effort", "volatile", "automatic"]),
    st.sampled_from(["transient_local", "manual_by_topic", "system_default", "unknown", "new one"]),
)
SPAN = st.fixed_dictionaries({"sec": st.integers(0, 2**30), "nsec": st.integers(0, 10**9 - 1)})


@given(
    st.lists(
        st.fixed_dictionaries(
            {
                **dict.fromkeys(["history", "reliability", "durability", "liveliness"], POLICY),
                **dict.fromkeys(["deadline", "lifespan", "liveliness_lease_duration"], SPAN),
                "depth": st.integers(0, 1_000),
                "avoid_ros_namespace_conventions": st.booleans(),
            }
        ),
        max_size=4,
    )
)
def test_qos_is_what_another_library_reads_as_text_and_as_list(profiles: list[dict[str, object]]):
    text = yaml.safe_dump(profiles)
    found = profiles_of(text)
    assert profiles_of(profiles) == found
    for one, other in zip(found, parse_qos(text), strict=True):
        assert (one.history.name, one.depth) == (other.history.name, other.depth)
        assert one.reliability.name == other.reliability.name
        assert one.durability.name == other.durability.name
        # ROS 2 took that policy back before Humble.
        liveliness = other.liveliness.name.replace("MANUAL_BY_NODE", "UNKNOWN")
        assert one.liveliness.name == liveliness
        for name in ("deadline", "lifespan", "liveliness_lease_duration"):
            span = getattr(other, name)
            assert getattr(one, name) == Duration(seconds=span.sec, nanoseconds=span.nsec)


def _bomb(line: str) -> str:
    """Nine of the one before on each of ten levels: 3 billion of them, if they were copied."""
    start = "a0: &a0 {x: 1}\n" if "<<" in line else "a0: &a0 [x]\n"
    levels = (line.format(n=n + 1, many=", ".join([f"*a{n}"] * 9)) + "\n" for n in range(10))
    return start + "".join(levels)


def _other(**fields: object) -> str:
    """Sound metadata, but for some fields."""
    text: dict[str, Any] = yaml.safe_load(GOOD)
    about = {**text["rosbag2_bagfile_information"], **fields}
    return yaml.safe_dump({"rosbag2_bagfile_information": about})


GOOD = metadata_text(9, ["bag_0.mcap"])
MERGES = _bomb("a{n}: &a{n} {{<<: [{many}]}}")
LISTS = _bomb("a{n}: &a{n} [{many}]")
HOSTILE = {
    "no YAML": "a: [",
    "nothing": "",
    "a list": "- a\n- b\n",
    "nested deeply": "[" * 100_000,
    "newer": _other(version=10),
    "endless version": _other(version=math.inf),
    "endless time": _other(starting_time={"nanoseconds_since_epoch": math.inf}),
    "no files": _other(relative_file_paths=None),
    "files are a number": _other(relative_file_paths=7),
    "a file is a list": _other(relative_file_paths=[["bag_0.mcap"]]),
    "a topic is a number": _other(topics_with_message_count=[7]),
    "Python's own objects": "a: !!python/object/apply:os.getcwd []\n",
    "merges of merges": MERGES + GOOD,
    "a text that is a bomb": LISTS + GOOD.replace("identifier: mcap", "identifier: *a10"),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_what_is_no_metadata_is_a_sentence_and_its_files_are_read(tmp_path: Path, kind: str):
    told = some_messages(30)
    write(tmp_path / "bag", told)
    (tmp_path / "bag" / "metadata.yaml").write_text(HOSTILE[kind])
    watch = Stopwatch()
    found = read_bag(tmp_path / "bag", tmp_path / "kept")
    assert watch.s < 3
    assert found.messages == told
    (trouble,) = found.troubles
    assert trouble.startswith("metadata.yaml cannot be read: ")
    assert len(trouble) < 300


def test_metadata_of_any_size_is_not_read(tmp_path: Path):
    with (tmp_path / "metadata.yaml").open("wb") as stream:
        stream.truncate(METADATA_BYTES_MAX + 1)
    with pytest.raises(BagNotReadableError, match="larger than"):
        read_metadata(tmp_path / "metadata.yaml")


def test_names_of_files_lead_nowhere_out_of_the_folder(tmp_path: Path):
    write(tmp_path / "other", some_messages(10))
    (tmp_path / "bag").mkdir()
    names = ["../other/other_0.mcap", str(tmp_path / "other" / "other_0.mcap"), "..", ""]
    (tmp_path / "bag" / "metadata.yaml").write_text(metadata_text(9, names))
    with pytest.raises(BagNotReadableError, match="and not there"):
        open_bag(tmp_path / "bag", kept_in=tmp_path / "kept")


@pytest.mark.parametrize(
    "offered", ["", "a: [", 7, None, [7], [{}], {"history": 1}, "x" * 300_000, LISTS, MERGES]
)
def test_qos_that_is_wrong_is_none(offered: object):
    assert profiles_of(offered) == ()


def test_compression_is_told_in_small_letters_and_none_is_empty():
    for said, read in (("FILE", "file"), ("MESSAGE", "message"), ("NONE", ""), ("", "")):
        text = GOOD.replace("compression_mode: ''", f"compression_mode: '{said}'")
        assert metadata_of(text).compression_mode == read
