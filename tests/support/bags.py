"""Bags made for tests: by the libraries, in every storage and compression, small and the same."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Final

from mcap.writer import CompressionType, IndexType, Writer

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

BEGIN_NS: Final = 1_700_000_000_000_000_000
STRING: Final = "string data\n"
TRANSIENT_QOS: Final = """- history: 1
  depth: 1
  reliability: 1
  durability: 1
  deadline:
    sec: 9223372036
    nsec: 854775807
  lifespan:
    sec: 9223372036
    nsec: 854775807
  liveliness: 1
  liveliness_lease_duration:
    sec: 9223372036
    nsec: 854775807
  avoid_ros_namespace_conventions: false
"""


class Chunks(Enum):
    """How the chunks of an MCAP file are compressed."""

    NONE = CompressionType.NONE
    LZ4 = CompressionType.LZ4
    ZSTD = CompressionType.ZSTD


@dataclass(frozen=True, slots=True)
class Told:
    """A message that is written: times in ns from `BEGIN_NS`."""

    topic: str
    at_ns: int
    text: str = "hello"
    type_name: str = "std_msgs/msg/String"
    sequence: int = 0
    sent_ns: int | None = None


def string_cdr(text: str) -> bytes:
    """Return a `std_msgs/msg/String` as it is on the wire."""
    data = text.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(data)) + data


def write_mcap(  # noqa: PLR0913 - what a writer of MCAP can be told
    file: Path,
    messages: Iterable[Told],
    *,
    chunks: Chunks = Chunks.ZSTD,
    chunk_bytes: int = 1_000,
    chunked: bool = True,
    index: IndexType = IndexType.ALL,
    latched: Iterable[str] = (),
    schemas: dict[str, str] | None = None,
    encoding: str = "cdr",
) -> Path:
    """Write an MCAP file as a recorder of ROS 2 does, with the library."""
    latched = set(latched)
    texts = {"std_msgs/msg/String": STRING, **(schemas or {})}
    with file.open("wb") as stream:
        writer = Writer(
            stream,
            chunk_size=chunk_bytes,
            compression=chunks.value,
            use_chunking=chunked,
            index_types=index,
        )
        writer.start(profile="ros2", library="tests")
        kinds: dict[str, int] = {}
        channels: dict[tuple[str, str], int] = {}
        for one in messages:
            if one.type_name not in kinds:
                text = texts[one.type_name]
                kinds[one.type_name] = writer.register_schema(
                    one.type_name, "ros2msg", text.encode()
                )
            key = (one.topic, one.type_name)
            if key not in channels:
                qos = {"offered_qos_profiles": TRANSIENT_QOS} if one.topic in latched else {}
                channels[key] = writer.register_channel(
                    one.topic, encoding, kinds[one.type_name], qos
                )
            at_ns = BEGIN_NS + one.at_ns
            sent_ns = at_ns if one.sent_ns is None else BEGIN_NS + one.sent_ns
            writer.add_message(channels[key], at_ns, string_cdr(one.text), sent_ns, one.sequence)
        writer.finish()
    return file


@dataclass(frozen=True, slots=True)
class McapForm:
    """How an MCAP file is written."""

    chunks: Chunks = Chunks.NONE
    chunk_bytes: int = 1_000
    chunked: bool = True
    indexed: bool = True


def write_raw_mcap(file: Path, told: Iterable[tuple[str, int, bytes]], form: McapForm) -> Path:
    """Write topic, time and bytes of messages of `std_msgs/msg/String` with the library."""
    with file.open("wb") as stream:
        writer = Writer(
            stream,
            chunk_size=form.chunk_bytes,
            compression=form.chunks.value,
            use_chunking=form.chunked,
            index_types=IndexType.ALL if form.indexed else IndexType.NONE,
        )
        writer.start(profile="ros2", library="tests")
        kind = writer.register_schema("std_msgs/msg/String", "ros2msg", STRING.encode())
        channels = {
            topic: writer.register_channel(topic, "cdr", kind)
            for topic in sorted({one[0] for one in told})
        }
        for number, (topic, at_ns, payload) in enumerate(told):
            writer.add_message(channels[topic], at_ns, payload, at_ns, number)
        writer.finish()
    return file
