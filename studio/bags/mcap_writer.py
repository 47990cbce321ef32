"""McapWriter: an .mcap file as rosbag2 writes it, in chunks that are whole once written."""

from __future__ import annotations

import contextlib
import itertools
import struct
import zlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal, TypeAlias, cast

import lz4.frame
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

from studio import __version__
from studio.bags.metadata_text import Span, qos_text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from io import FileIO
    from pathlib import Path

    from studio.bags.recording import RecordedTopic
    from studio.ros.node.samples import RawSample

ChunkCompression: TypeAlias = Literal["", "zstd", "lz4"]
CHUNK_BYTES: Final = 1024 * 1024
_MAGIC: Final = b"\x89MCAP0\r\n"
_LARGE_BYTES: Final = 32 * 1024
"""A part of a chunk that is written from where it lies; smaller ones are joined first."""
_MESSAGE: Final = struct.Struct("<BQHIQQ")
_CHUNK_TIMES: Final = struct.Struct("<QQQI")
_SEQUENCE_MASK: Final = 2**32 - 1


@dataclass(frozen=True, slots=True)
class Chunking:
    """How large chunks are, in bytes, and how they are compressed; a level of zstd's."""

    bytes: int = CHUNK_BYTES
    compression: ChunkCompression = ""
    level: int = 1
    with_crc: bool = True


@dataclass(slots=True)
class _Chunk:
    """Messages that wait to be written together."""

    parts: list[bytes] = field(default_factory=list[bytes])
    size: int = 0
    span: Span = field(default_factory=Span)
    indexes: dict[int, list[int]] = field(default_factory=dict[int, list[int]])
    """By topic: time and offset of each message, one after the other."""


@dataclass(frozen=True, slots=True)
class _Written:
    """A chunk in the file, where it and its indexes end, and what is in it."""

    index: ChunkIndex
    end: int
    span: Span
    counts: Mapping[int, int]


class McapWriter:
    """Writes a new file; see `StorageFile`.

    Records are made by the library, those that come with every message here: with its writer a
    message takes three times as long, and a large one is copied five times.
    """

    def __init__(self, path: Path, chunking: Chunking) -> None:
        self._file = path.open("xb", buffering=0)
        self._chunking = chunking
        self._compress = _compressor(chunking)
        self._end = 0
        """Where the next record goes: behind the last that is whole."""
        self._topics: dict[int, RecordedTopic] = {}
        self._schemas: dict[str, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self._chunk = _Chunk()
        self._written: list[_Written] = []
        self.span = Span()
        self.counts: dict[int, int] = {}
        self._append([_MAGIC, _record(Header("ros2", f"robot-description-studio {__version__}"))])

    @property
    def size(self) -> int:
        """Bytes, those that wait to be written among them."""
        return self._end + self._chunk.size

    def add_topic(self, number: int, topic: RecordedTopic, definition: str) -> None:
        """Announce a topic, outside of chunks: it is there whatever becomes of them."""
        schema = self._schemas.get(topic.type_name)
        records: list[bytes] = []
        if schema is None:
            encoding = "ros2msg" if definition else ""
            schema = Schema(len(self._schemas) + 1, definition.encode(), encoding, topic.type_name)
            self._schemas[topic.type_name] = schema
            records.append(_record(schema))
        metadata = {"offered_qos_profiles": qos_text(topic.qos), "topic_type_hash": topic.type_hash}
        channel = self._channels[number] = Channel(number, topic.name, "cdr", metadata, schema.id)
        self.counts[number] = 0
        self._append([*records, _record(channel)])

    def write(self, number: int, sample: RawSample) -> None:
        """Add a message; a chunk that is full is written."""
        payload, (sequence, source_ns, _), at_ns = sample
        chunk, length = self._chunk, len(payload)
        head = _MESSAGE.pack(
            Opcode.MESSAGE, length + 22, number, sequence & _SEQUENCE_MASK, at_ns, max(0, source_ns)
        )
        index = chunk.indexes.get(number)
        if index is None:
            index = chunk.indexes[number] = []
        index += (at_ns, chunk.size)
        chunk.parts += (head, payload)
        chunk.size += _MESSAGE.size + length
        chunk.span.add(at_ns)
        self.span.add(at_ns)
        self.counts[number] += 1
        if chunk.size >= self._chunking.bytes:
            self.flush()

    def flush(self) -> None:
        """Write the chunk that waits, with the indexes of its messages."""
        chunk = self._chunk
        if not chunk.parts:
            return
        parts, compressed_size = self._compressed(chunk)
        head = self._chunk_head(chunk, compressed_size)
        start, length = self._end, len(head) + compressed_size
        indexes, offsets = _indexes(chunk, start + length)
        self._append([head, *parts, *indexes])
        self._chunk = _Chunk()
        made = ChunkIndex(
            chunk_length=length,
            chunk_start_offset=start,
            compression=self._chunking.compression,
            compressed_size=compressed_size,
            message_end_time=chunk.span.end_ns,
            message_index_length=self._end - start - length,
            message_index_offsets=offsets,
            message_start_time=chunk.span.begin_ns,
            uncompressed_size=chunk.size,
        )
        counts = {number: len(index) // 2 for number, index in chunk.indexes.items()}
        self._written.append(_Written(made, self._end, chunk.span, counts))

    def close(self, information: Callable[[], str]) -> None:
        """Write what waits, and the summary; on a full disk last chunks make room for it."""
        try:
            self._complete(information)
        finally:
            self._file.close()

    def abandon(self) -> None:
        """Let go of the file as it is."""
        self._file.close()

    def _complete(self, information: Callable[[], str]) -> None:
        try:
            self.flush()
        except OSError:
            self._forget_waiting()
        while True:
            try:
                self._append(self._summary(information()))
            except OSError:
                if not self._written:
                    raise
                self._drop_last_chunk()
            else:
                return

    def _forget_waiting(self) -> None:
        self._chunk = _Chunk()
        self._count_again()

    def _drop_last_chunk(self) -> None:
        self._end = self._written.pop().index.chunk_start_offset
        self._cut_off()
        self._count_again()

    def _count_again(self) -> None:
        self.span, self.counts = Span(), dict.fromkeys(self.counts, 0)
        for one in self._written:
            self.span.join(one.span)
            for number, count in one.counts.items():
                self.counts[number] += count

    def _append(self, parts: Iterable[bytes]) -> None:
        """Write at the end; of what the disk refuses nothing stays."""
        try:
            written = 0
            for run in _runs(parts):
                written += _write_whole(self._file, run)
        except OSError:
            with contextlib.suppress(OSError):
                self._cut_off()
            raise
        self._end += written

    def _cut_off(self) -> None:
        self._file.seek(self._end)
        self._file.truncate()

    def _compressed(self, chunk: _Chunk) -> tuple[list[bytes], int]:
        """Return the records of a chunk as they are written, and their size."""
        if self._compress is None:
            return chunk.parts, chunk.size
        compressed = self._compress(b"".join(chunk.parts))
        return [compressed], len(compressed)

    def _chunk_head(self, chunk: _Chunk, compressed_size: int) -> bytes:
        """Return all of the record that comes before its data."""
        crc = 0
        if self._chunking.with_crc:
            for run in _runs(chunk.parts):
                crc = zlib.crc32(run, crc)
        name = self._chunking.compression.encode()
        content = b"".join(
            (
                _CHUNK_TIMES.pack(chunk.span.begin_ns, chunk.span.end_ns, chunk.size, crc),
                struct.pack("<I", len(name)),
                name,
                struct.pack("<Q", compressed_size),
            )
        )
        return struct.pack("<BQ", Opcode.CHUNK, len(content) + compressed_size) + content

    def _summary(self, information: str) -> list[bytes]:
        """Return all that comes after the last chunk, with offsets for where the file ends now."""
        metadata = Metadata("rosbag2", {"serialized_metadata": information})
        before = _record(metadata)
        index = MetadataIndex(self._end, len(before), metadata.name)
        end = _record(DataEnd(0))
        start = self._end + len(before) + len(end)
        groups: list[tuple[Opcode, list[McapRecord]]] = [
            (Opcode.SCHEMA, [*self._schemas.values()]),
            (Opcode.CHANNEL, [*self._channels.values()]),
            (Opcode.STATISTICS, [self._statistics()]),
            (Opcode.CHUNK_INDEX, [one.index for one in self._written]),
            (Opcode.METADATA_INDEX, [index]),
        ]
        summary, offsets = b"", b""
        for opcode, records in groups:
            group = _record(*records)
            if group:
                offsets += _record(SummaryOffset(opcode, start + len(summary), len(group)))
            summary += group
        offset_start = start + len(summary)
        summary += offsets
        head = struct.pack("<BQQQ", Opcode.FOOTER, 20, start, offset_start)
        footer = _record(Footer(start, offset_start, zlib.crc32(head, zlib.crc32(summary))))
        return [before, end, summary, footer, _MAGIC]

    def _statistics(self) -> Statistics:
        span = self.span
        return Statistics(
            attachment_count=0,
            channel_count=len(self._channels),
            channel_message_counts=dict(self.counts),
            chunk_count=len(self._written),
            message_count=span.count,
            message_end_time=span.end_ns,
            message_start_time=span.begin_ns if span.count else 0,
            metadata_count=1,
            schema_count=len(self._schemas),
        )


def _record(*records: McapRecord) -> bytes:
    builder = RecordBuilder()
    for one in records:
        one.write(builder)
    return builder.end()


def _indexes(chunk: _Chunk, begin: int) -> tuple[list[bytes], dict[int, int]]:
    """Return the message indexes of a chunk, and where each is in the file."""
    records: list[bytes] = []
    offsets: dict[int, int] = {}
    for number, index in chunk.indexes.items():
        offsets[number] = begin
        size = 8 * len(index)
        head = struct.pack("<BQHI", Opcode.MESSAGE_INDEX, size + 6, number, size)
        records.append(head + struct.pack(f"<{len(index)}Q", *index))
        begin += len(records[-1])
    return records, offsets


def _runs(parts: Iterable[bytes]) -> Iterator[bytes]:
    """Join small parts that follow each other; a large one stays where it lies."""
    for is_large, run in itertools.groupby(parts, lambda part: len(part) >= _LARGE_BYTES):
        if is_large:
            yield from run
        else:
            yield b"".join(run)


def _write_whole(file: FileIO, data: bytes) -> int:
    """Write all, in several calls where the system takes only a part at once; return the size."""
    view = memoryview(data)
    while view:
        view = view[file.write(view) :]
    return len(data)


def _compressor(chunking: Chunking) -> Callable[[bytes], bytes] | None:
    match chunking.compression:
        case "zstd":
            return zstandard.ZstdCompressor(level=chunking.level).compress
        case "lz4":
            return cast("Callable[[bytes], bytes]", lz4.frame.compress)  # pyright: ignore[reportUnknownMemberType] - untyped
        case "":
            return None
