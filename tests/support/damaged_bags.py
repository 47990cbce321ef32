"""Damage to files of bags; in MCAP files, put where the library says that a thing lies."""

from __future__ import annotations

import os
import struct
from typing import TYPE_CHECKING, Final

from mcap.data_stream import RecordBuilder
from mcap.reader import make_reader
from mcap.records import Footer

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from mcap.records import ChunkIndex
    from mcap.summary import Summary

MAGIC: Final = b"\x89MCAP0\r\n"
_FOOTER_BYTES: Final = 9 + 20
_CHUNK_CRC_AT: Final = 9 + 24
_CHUNK_SIZE_AT: Final = 9 + 16


def summary_of(file: Path) -> Summary:
    """The summary as the library reads it."""
    with file.open("rb") as stream:
        found = make_reader(stream).get_summary()
    assert found is not None
    return found


def chunks_of(file: Path) -> list[ChunkIndex]:
    """Where the chunks of a file lie, in its order."""
    return sorted(summary_of(file).chunk_indexes, key=lambda one: one.chunk_start_offset)


def data_at(chunk: ChunkIndex) -> int:
    """Where the data of a chunk begins in the file."""
    return chunk.chunk_start_offset + chunk.chunk_length - chunk.compressed_size


def overwrite(file: Path, at: int, data: bytes) -> None:
    """Put bytes in the place of others."""
    with file.open("r+b") as stream:
        stream.seek(at)
        stream.write(data)


def put_crc(file: Path, chunk: ChunkIndex, crc: int) -> None:
    """Have a chunk state another checksum."""
    overwrite(file, chunk.chunk_start_offset + _CHUNK_CRC_AT, struct.pack("<I", crc))


def put_size(file: Path, chunk: ChunkIndex, size: int) -> None:
    """Have a chunk claim to unpack to so many bytes."""
    overwrite(file, chunk.chunk_start_offset + _CHUNK_SIZE_AT, struct.pack("<Q", size))


def put_index(
    file: Path, change: Callable[[int, ChunkIndex], None], *, at: int | None = None
) -> None:
    """Write the summary anew, with the index of each chunk, given with its number, changed.

    Args:
        file: The file.
        change: Changes the index of a chunk.
        at: Where the summary is to begin, behind zeros that take no room; None: where it did.
    """
    summary = summary_of(file)
    begin = at or _summary_start(file)
    builder = RecordBuilder()
    assert summary.statistics is not None
    for one in (*summary.schemas.values(), *summary.channels.values(), summary.statistics):
        one.write(builder)
    chunks = sorted(summary.chunk_indexes, key=lambda one: one.chunk_start_offset)
    for number, chunk in enumerate(chunks):
        change(number, chunk)
        chunk.write(builder)
    Footer(summary_start=begin, summary_offset_start=0, summary_crc=0).write(builder)
    os.truncate(file, begin)
    overwrite(file, begin, builder.end() + MAGIC)


def cut_out(file: Path, begin: int, end: int) -> None:
    """Remove bytes in the middle: all behind them moves forward, and no index knows."""
    data = file.read_bytes()
    file.write_bytes(data[:begin] + data[end:])


def _summary_start(file: Path) -> int:
    data = file.read_bytes()
    return struct.unpack_from("<Q", data, len(data) - len(MAGIC) - _FOOTER_BYTES + 9)[0]
