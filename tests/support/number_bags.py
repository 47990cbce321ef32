"""Bags of numbers: one float64 in each message, quickly made however many they are."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING, Final

import numpy as np
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Schema,
    Statistics,
)
from mcap.writer import CompressionType, Writer

from tests.support.bags import BEGIN_NS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path
    from typing import BinaryIO

    from numpy.typing import NDArray

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


_MESSAGE: Final = np.dtype(
    [
        *(("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("sequence", "<u4")),
        *(("log_time", "<u8"), ("publish_time", "<u8"), ("cdr", "u1", 20), ("xyz", "<f8", 3)),
    ]
)
_ENTRY: Final = np.dtype([("log_time", "<u8"), ("offset", "<u8")])
_CHUNK: Final = 14_000
"""Messages of one: about a megabyte."""
PERIOD_NS: Final = 1_000_000


def write_many(file: Path, count: int) -> Path:
    """Write a wave at 1 kHz into an MCAP file of zstd, made by numpy: a second for a million."""
    index: list[ChunkIndex] = []
    with file.open("wb") as stream:
        _put(stream, b"\x89MCAP0\r\n")
        _record(stream, Header(profile="ros2", library="tests"))
        for first in range(0, count, _CHUNK):
            messages = _messages(first, min(_CHUNK, count - first))
            index.append(_chunk(stream, messages))
        _record(stream, DataEnd(data_section_crc=0))
        summary = stream.tell()
        for one in (*_DEFINITIONS, *index, _statistics(count, len(index))):
            _record(stream, one)
        _record(stream, Footer(summary_start=summary, summary_offset_start=0, summary_crc=0))
        _put(stream, b"\x89MCAP0\r\n")
    return file


def wave(numbers: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the values of messages by their numbers; one in 100,003 is far off."""
    return np.sin(numbers / 50_000) + np.where(numbers % 100_003 == 77, 5.0, 0.0)


_DEFINITIONS: Final = (
    Schema(id=1, name=TYPE, encoding="ros2msg", data=SCHEMA.encode()),
    Channel(id=1, topic="/points", message_encoding="cdr", metadata={}, schema_id=1),
)


def _messages(first: int, count: int) -> NDArray[np.void]:
    numbers = np.arange(first, first + count)
    made = np.zeros(count, _MESSAGE)
    made["opcode"], made["length"], made["channel"] = 5, _MESSAGE.itemsize - 9, 1
    made["sequence"] = numbers
    made["log_time"] = made["publish_time"] = BEGIN_NS + numbers * PERIOD_NS
    made["cdr"] = np.frombuffer(point_cdr(0.0)[:20], np.uint8)
    made["xyz"][:, 0] = wave(numbers)
    return made


def _chunk(stream: BinaryIO, messages: NDArray[np.void]) -> ChunkIndex:
    builder = RecordBuilder()
    for one in _DEFINITIONS:
        one.write(builder)
    head = builder.end()
    plain = head + messages.tobytes()
    packed = zstandard.compress(plain, 1)
    times, start = messages["log_time"], stream.tell()
    begin, end = int(times[0]), int(times[-1])
    _record(
        stream,
        Chunk(
            compression="zstd", data=packed, message_start_time=begin, message_end_time=end,
            uncompressed_crc=zlib.crc32(plain), uncompressed_size=len(plain),
        ),
    )  # fmt: skip
    length, index_at = stream.tell() - start, stream.tell()
    entries = np.zeros(messages.size, _ENTRY)
    entries["log_time"] = times
    entries["offset"] = len(head) + np.arange(messages.size) * _MESSAGE.itemsize
    _put(stream, struct.pack("<BQHI", 7, 6 + entries.nbytes, 1, entries.nbytes))
    _put(stream, entries.tobytes())
    return ChunkIndex(
        chunk_length=length, chunk_start_offset=start, compression="zstd",
        compressed_size=len(packed), message_end_time=end, message_index_length=stream.tell()
        - index_at, message_index_offsets={1: index_at}, message_start_time=begin,
        uncompressed_size=len(plain),
    )  # fmt: skip


def _statistics(count: int, chunks: int) -> Statistics:
    return Statistics(
        attachment_count=0, channel_count=1, channel_message_counts={1: count},
        chunk_count=chunks, message_count=count, message_start_time=BEGIN_NS,
        message_end_time=BEGIN_NS + (count - 1) * PERIOD_NS, metadata_count=0, schema_count=1,
    )  # fmt: skip


def _record(stream: BinaryIO, record: McapRecord) -> None:
    builder = RecordBuilder()
    record.write(builder)
    _put(stream, builder.end())


def _put(stream: BinaryIO, data: bytes) -> None:
    stream.write(data)
