"""Bags of numbers: one float64 in each message, quickly made however many they are."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Final

from mcap.writer import CompressionType, Writer

from tests.support.bags import BEGIN_NS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

TYPE: Final = "geometry_msgs/msg/PointStamped"
SCHEMA: Final = """std_msgs/Header header
geometry_msgs/Point point
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
"""
PATH: Final = ".point.x"
_CDR: Final = struct.Struct("<4xiII4s3d").pack


def point_cdr(number: float, frame: bytes = b"map\0") -> bytes:
    """Return a `geometry_msgs/msg/PointStamped` whose x is a number."""
    return b"\0\1" + _CDR(0, 0, len(frame), frame, number, 0.0, 0.0)[2:]


def write_numbers(
    file: Path,
    numbers: Iterable[tuple[int, float]],
    *,
    topic: str = "/points",
    chunk_bytes: int = 1 << 20,
    compression: CompressionType = CompressionType.NONE,
) -> Path:
    """Write an MCAP file; times in ns from `BEGIN_NS`."""
    with file.open("wb") as stream:
        writer = Writer(stream, chunk_size=chunk_bytes, compression=compression)
        writer.start(profile="ros2", library="tests")
        kind = writer.register_schema(TYPE, "ros2msg", SCHEMA.encode())
        channel = writer.register_channel(topic, "cdr", kind)
        for n, (at_ns, number) in enumerate(numbers):
            time_ns = BEGIN_NS + at_ns
            writer.add_message(channel, time_ns, point_cdr(number), time_ns, n)
        writer.finish()
    return file
