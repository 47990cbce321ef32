"""Bags that tests write, and what the libraries of others read of them."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Final

from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Message
from mcap.stream_reader import StreamReader
from rosbags.rosbag2 import Reader

from studio.bags.recording import RecordedTopic
from studio.bags.writer import BagWriter
from studio.ros.attachment import Attachment
from studio.ros.node.samples import RawSample
from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from studio.bags.writer import Storing, Written

Told = tuple[str, int, bytes]
"""A message: its topic, when it came, and its bytes."""
TYPES: Final = TypeLibrary("jazzy")
BEGIN_NS: Final = 1_700_000_000_000_000_000
GID: Final = bytes(16)
LATCHED: Final = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KINDS: Final = {
    "/words": "std_msgs/msg/String",
    "/image": "sensor_msgs/msg/Image",
    "/description": "std_msgs/msg/String",
    "/strange": "nobody_msgs/msg/Foo",
}


def recorded_topic(name: str) -> RecordedTopic:
    """A topic of `KINDS`; that of the description is latched."""
    kind = KINDS[name]
    known = "RIHS01_" + "0" * 64 if kind.startswith("nobody") else TYPES.hash_of(kind)
    qos = LATCHED if name == "/description" else QoSProfile(depth=10)
    return RecordedTopic(name, kind, known, (qos,))


def sample(at_ns: int, payload: bytes, number: int = 0) -> RawSample:
    """A message that was published a microsecond before it came."""
    return RawSample(payload, Attachment(number, at_ns - 1_000, GID), at_ns)


def write(folder: Path, told: Iterable[Told], storing: Storing | None = None) -> Written:
    """Write messages of topics of `KINDS`, each of which is in the bag."""
    writer = BagWriter(folder, TYPES, storing)
    numbers = {name: writer.add_topic(recorded_topic(name)) for name in KINDS}
    for number, (topic, at_ns, payload) in enumerate(told):
        writer.write(numbers[topic], sample(at_ns, payload, number))
    return writer.close()


def some_messages(count: int = 600) -> list[Told]:
    """Small messages of three topics, and a large one in between; one topic has none."""
    names = ("/words", "/image", "/strange")
    return [
        (
            names[place % 3],
            BEGIN_NS + place * 10_000_000,
            bytes([0, 1, 0, 0, place % 256]) * (40_000 if place % 97 == 1 else 11),
        )
        for place in range(count)
    ]


def told_by_rosbags(folder: Path) -> list[Told]:
    """All messages as rosbags reads them; it refuses what is not whole."""
    with Reader(folder) as reader:
        found = [(one.topic, at_ns, bytes(data)) for one, at_ns, data in reader.messages()]
        assert reader.message_count == len(found)
        return found


def told_by_mcap(file: Path) -> list[Told]:
    """All messages of a file as mcap reads them, every checksum checked."""
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        found = [
            (channel.topic, message.log_time, message.data)
            for _, channel, message in reader.iter_messages()
        ]
        assert summary.statistics.message_count == len(found)
        return found


def kept_in_mcap(file: Path) -> list[bytes]:
    """The messages of an unfinished file, up to where it breaks off."""
    found: list[bytes] = []
    with file.open("rb") as stream, contextlib.suppress(McapError):
        found.extend(one.data for one in StreamReader(stream).records if isinstance(one, Message))
    return found
