"""A part of a recording: its messages, and what a late subscriber would have been given."""

from __future__ import annotations

from contextlib import closing
from typing import TYPE_CHECKING

import pytest

from studio.bags.cutting import write_recording
from studio.bags.opening import open_bag
from studio.bags.recording import RecordedTopic
from studio.bags.writer import BagWriter
from studio.errors import RecordingError
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tests.support.bags import string_cdr
from tests.support.memory_recording import MemoryRecording
from tests.support.read_bags import read_bag
from tests.support.written_bags import BEGIN_NS, TYPES, sample, some_messages, write

if TYPE_CHECKING:
    from pathlib import Path

    from studio.bags.writer import Written


def _cut(folder: Path, begin_ns: int, end_ns: int, *topics: str) -> Written:
    shares: list[float] = []
    with closing(open_bag(folder / "bag", kept_in=folder / "kept")) as bag:
        written = write_recording(bag, folder / "cut", topics, begin_ns, end_ns, shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    return written


def test_a_part_has_the_messages_of_its_time_and_topics(tmp_path: Path):
    told = some_messages()
    write(tmp_path / "bag", told)
    begin_ns, end_ns = BEGIN_NS + 1_000_000_000, BEGIN_NS + 2_000_000_000
    written = _cut(tmp_path, begin_ns, end_ns, "/words", "/image")
    found = read_bag(tmp_path / "cut", tmp_path / "kept").messages
    assert found == [
        one for one in told if begin_ns <= one[1] < end_ns and one[0] in {"/words", "/image"}
    ]
    assert written.messages == len(found) == 67


@pytest.mark.parametrize(
    ("qos", "kept"),
    [
        (QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL), 2),
        (
            QoSProfile(history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL),
            5,
        ),
        (QoSProfile(depth=2), 0),
    ],
)
def test_a_part_begins_with_what_latched_topics_would_give(
    tmp_path: Path, qos: QoSProfile, kept: int
):
    with BagWriter(tmp_path / "bag", TYPES) as writer:
        topic = RecordedTopic("/robot_description", "std_msgs/msg/String", qos=(qos,))
        number = writer.add_topic(topic)
        for place in range(5):
            writer.write(number, sample(BEGIN_NS + place, string_cdr(str(place))))
        writer.write(number, sample(BEGIN_NS + 100, string_cdr("later")))
    _cut(tmp_path, BEGIN_NS + 50, BEGIN_NS + 101)
    found = read_bag(tmp_path / "cut", tmp_path / "kept").messages
    begin = [(topic.name, BEGIN_NS + 50, string_cdr(str(place))) for place in range(5)]
    assert found == [*begin[5 - kept :], (topic.name, BEGIN_NS + 100, string_cdr("later"))]


def test_a_part_that_is_empty_or_of_no_topic_is_refused_and_what_is_broken_off_leaves_nothing(
    tmp_path: Path,
):
    write(tmp_path / "bag", some_messages(30))
    with pytest.raises(RecordingError, match="comes before its beginning"):
        _cut(tmp_path, BEGIN_NS, BEGIN_NS)
    with pytest.raises(RecordingError, match="no topic /nobody"):
        _cut(tmp_path, BEGIN_NS, BEGIN_NS + 10**9, "/nobody")

    def break_off(share: float) -> None:
        raise KeyboardInterrupt(share)

    with (
        closing(open_bag(tmp_path / "bag", kept_in=tmp_path / "kept")) as bag,
        pytest.raises(KeyboardInterrupt),
    ):
        write_recording(bag, tmp_path / "cut", [], BEGIN_NS, BEGIN_NS + 10**9, break_off)
    assert not (tmp_path / "cut").exists()


def test_messages_that_are_not_of_ros_2_are_left_out_and_refused_by_name(tmp_path: Path):
    recording = MemoryRecording()
    recording.add_topic("/words", "std_msgs/msg/String")
    recording.say("/words", BEGIN_NS, data="a")
    recording.add_topic("/other", "thing", encoding="json")
    recording.add("/other", BEGIN_NS, b"{}")
    span_ns = BEGIN_NS, BEGIN_NS + 1
    write_recording(recording, tmp_path / "cut", [], *span_ns, lambda _: None)
    assert [one[0] for one in read_bag(tmp_path / "cut").messages] == ["/words"]
    with pytest.raises(RecordingError, match='"json": only messages of ROS 2'):
        write_recording(recording, tmp_path / "none", ["/other"], *span_ns, lambda _: None)
    assert not (tmp_path / "none").exists()
