"""The index of an MCAP file, as its summary gives it."""

from __future__ import annotations

import os
import zlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.bags import mcap_records
from studio.bags.blocks import BlockTable
from studio.bags.compression import PART_BYTES_MAX
from studio.bags.mcap_records import (
    CHUNK_INDEX,
    FOOTER,
    FOOTER_RECORD,
    HEAD,
    MAGIC,
    TAIL_BYTES,
    ChannelRecord,
    read_channel,
    read_schema,
    read_statistics,
    records,
)
from studio.errors import DamagedPartError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.bags.blocks import Definition

RECORD_BYTES_MAX: Final = PART_BYTES_MAX + 2**16
"""Of a chunk, or of messages in no chunk, as they lie in the file; what is longer is rubbish."""
SUMMARY_BYTES_MAX: Final = 2**30
"""A larger one is read by nobody: 10 million pairs of chunk and channel take 100 MB."""
_ENTRY: Final = np.dtype([("channel", "<u2"), ("at", "<i8")])
_CHUNK_INDEX: Final = np.dtype(
    [("begin", "<i8"), ("end", "<i8"), ("at", "<i8"), ("length", "<i8"), ("entries", "<u4")]
)
_INDEX_LENGTH: Final = np.dtype("<i8")


@dataclass(frozen=True, slots=True)
class McapBlocks:
    """Where the blocks of a file lie: chunks, or stretches of messages that stand in no chunk.

    Attributes:
        begins_ns: Of each block, shape (N,), int64, as all until `index_ends`.
        ends_ns: The last time in each.
        starts: Where its first record begins in the file.
        lengths: Bytes of its record, or of its records.
        index_ends: Where the message indexes after it end.
        are_chunks: Whether each is a chunk, shape (N,), bool.
        pair_channels: A channel that is in a block, shape (M,), int64.
        pair_blocks: The block, int32.
        pair_places: Where the message index of the channel in that block lies, int64; 0: it has
            none, and the block is scanned instead.
    """

    begins_ns: NDArray[np.int64]
    ends_ns: NDArray[np.int64]
    starts: NDArray[np.int64]
    lengths: NDArray[np.int64]
    index_ends: NDArray[np.int64]
    are_chunks: NDArray[np.bool_]
    pair_channels: NDArray[np.int64]
    pair_blocks: NDArray[np.int32]
    pair_places: NDArray[np.int64]

    def by_begin(self) -> McapBlocks:
        """Return them numbered by their begins."""
        order = np.lexsort((self.starts, self.begins_ns))
        numbers = np.empty(len(order), np.int32)
        numbers[order] = np.arange(len(order), dtype=np.int32)
        return McapBlocks(
            self.begins_ns[order],
            self.ends_ns[order],
            self.starts[order],
            self.lengths[order],
            self.index_ends[order],
            self.are_chunks[order],
            self.pair_channels,
            numbers[self.pair_blocks],
            self.pair_places,
        )

    def table(self) -> BlockTable:
        """Return what readers ask; the blocks are numbered by their begins."""
        pairs = (self.pair_channels, self.pair_blocks, self.pair_places)
        return BlockTable.of(self.begins_ns, self.ends_ns, self.starts, pairs)


@dataclass(frozen=True, slots=True)
class McapIndex:
    """What a file holds, and where.

    Attributes:
        counts: Messages by channel.
        metadata: What stands beside the messages under the name of rosbag2.
        troubles: What is damaged, a sentence each.
    """

    blocks: McapBlocks
    schemas: dict[int, Definition]
    channels: dict[int, ChannelRecord]
    counts: dict[int, int]
    metadata: dict[str, str] = field(default_factory=dict[str, str])
    troubles: tuple[str, ...] = ()


def read_exactly(handle: int, length: int, at: int, bytes_max: int = RECORD_BYTES_MAX) -> bytes:
    """Read a part of a file.

    Raises:
        DamagedPartError: The file ends before it, or it is larger than `bytes_max`.
        OSError: The disk refuses it.
    """
    if length > bytes_max:
        raise DamagedPartError(f"a record has {length} bytes, more than any may")
    found = os.pread(handle, length, at)
    if len(found) < length:
        found += _more(handle, length - len(found), at + len(found))
    return found


def _more(handle: int, length: int, at: int) -> bytes:
    """Read what one call left: the system gives at most 2 GiB at once, or a file has ended."""
    parts: list[bytes] = []
    while length:
        part = os.pread(handle, length, at)
        if not part:
            raise DamagedPartError("the file ends before it")
        parts.append(part)
        length, at = length - len(part), at + len(part)
    return b"".join(parts)


def read_summary(handle: int, size: int) -> McapIndex:
    """Read the index from the summary at the end of a file.

    Raises:
        DamagedPartError: There is none, or it is damaged or not enough to read all by it.
        OSError: The disk refuses it.
    """
    data, begin = _summary_of(handle, size)
    found = _Summary(data)
    if found.chunk_count is not None and found.chunk_count != len(found.chunks):
        raise DamagedPartError("its index does not name all chunks")
    return found.index(begin)


def _summary_of(handle: int, size: int) -> tuple[bytes, int]:
    """Return the bytes of the summary, and where it begins."""
    if size < len(MAGIC) + TAIL_BYTES:
        raise DamagedPartError("it is too short to have an index")
    tail = read_exactly(handle, TAIL_BYTES, size - TAIL_BYTES)
    opcode, length, begin, _offsets, crc = FOOTER_RECORD.unpack_from(tail)
    whole = tail.endswith(MAGIC) and opcode == FOOTER and length == FOOTER_RECORD.size - HEAD.size
    end = size - TAIL_BYTES
    if not whole:
        raise DamagedPartError("it was not closed, so that it has no index")
    if not begin:
        raise DamagedPartError("it has no index")
    if not len(MAGIC) <= begin <= end or end - begin > SUMMARY_BYTES_MAX:
        raise DamagedPartError("its end points to no index")
    data = read_exactly(handle, end - begin, begin, SUMMARY_BYTES_MAX)
    if crc and zlib.crc32(tail[: FOOTER_RECORD.size - 4], zlib.crc32(data)) != crc:
        raise DamagedPartError("its index has a wrong checksum")
    return data, begin


class _Summary:
    """The records of a summary, sorted into what they are about."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self.schemas: dict[int, Definition] = {}
        self.channels: dict[int, ChannelRecord] = {}
        self.counts: dict[int, int] = {}
        self.message_count: int | None = None
        self.chunk_count: int | None = None
        self.chunks: list[tuple[int, int]] = []
        for opcode, begin, end in records(data):
            if opcode == CHUNK_INDEX:
                self.chunks.append((begin, end))
            else:
                self._take(opcode, memoryview(data)[begin:end])

    def _take(self, opcode: int, content: memoryview) -> None:
        match opcode:
            case mcap_records.SCHEMA:
                schema = read_schema(content)
                self.schemas[schema.key] = schema.definition
            case mcap_records.CHANNEL:
                channel = read_channel(content)
                self.channels[channel.key] = channel
            case mcap_records.STATISTICS:
                self.message_count, self.chunk_count, self.counts = read_statistics(content)
            case _:
                pass

    def index(self, end: int) -> McapIndex:
        """Make the index; `end` is where the data of the file end.

        Raises:
            DamagedPartError: Not all can be read by it.
        """
        heads = self._heads()
        pairs, blocks, index_lengths = self._pairs(heads["entries"])
        self._check(pairs, heads)
        starts, lengths = heads["at"].astype(np.int64), heads["length"].astype(np.int64)
        index_ends = starts + lengths + index_lengths
        # Each by itself as well: a sum of very large ones comes out small.
        numbers = np.concatenate([starts - len(MAGIC), lengths, index_lengths, index_ends])
        if numbers.min(initial=0) < 0 or numbers.max(initial=0) > end:
            raise DamagedPartError("its index points beyond its data")
        found = McapBlocks(
            heads["begin"].astype(np.int64),
            heads["end"].astype(np.int64),
            starts,
            lengths,
            index_ends,
            np.ones(len(heads), np.bool_),
            pairs["channel"].astype(np.int64),
            blocks,
            pairs["at"].astype(np.int64),
        )
        return McapIndex(found.by_begin(), self.schemas, self.channels, self.counts)

    def _heads(self) -> NDArray[np.void]:
        """Return the first fields of each chunk index, in the order of the file."""
        size = _CHUNK_INDEX.itemsize
        if any(end - begin < size for begin, end in self.chunks):
            raise DamagedPartError("its index is cut off")
        heads = np.frombuffer(
            b"".join(self._data[at : at + size] for at, _ in self.chunks), _CHUNK_INDEX
        )
        order = np.argsort(heads["at"], kind="stable")
        self.chunks = [self.chunks[i] for i in order.tolist()]
        return heads[order]

    def _pairs(
        self, entries_bytes: NDArray[np.uint32]
    ) -> tuple[NDArray[np.void], NDArray[np.int32], NDArray[np.int64]]:
        """Return channel and place of each message index, its block, and the lengths by block."""
        parts: list[bytes] = []
        lengths: list[bytes] = []
        size = _CHUNK_INDEX.itemsize
        for (begin, end), count in zip(self.chunks, entries_bytes.tolist(), strict=True):
            at = begin + size
            if count % _ENTRY.itemsize or at + count + 8 > end:
                raise DamagedPartError("its index is cut off")
            parts.append(self._data[at : at + count])
            lengths.append(self._data[at + count : at + count + 8])
        pairs = np.frombuffer(b"".join(parts), _ENTRY)
        blocks = np.repeat(np.arange(len(parts), dtype=np.int32), entries_bytes // _ENTRY.itemsize)
        return pairs, blocks, np.frombuffer(b"".join(lengths), _INDEX_LENGTH)

    def _check(self, pairs: NDArray[np.void], heads: NDArray[np.void]) -> None:
        """Refuse a summary by which not every message would be found."""
        if self.message_count is None or self.message_count != sum(self.counts.values()):
            raise DamagedPartError("its index does not count the messages of each topic")
        if not len(heads) and self.message_count:
            raise DamagedPartError("its messages stand in no chunk")
        if np.any((heads["entries"] == 0) & (heads["length"] > 0) & (heads["end"] > 0)):
            raise DamagedPartError("its index does not say what is in each chunk")
        # Not `np.unique`, which takes longer than all the rest: it imports masked arrays first.
        if not set(np.flatnonzero(np.bincount(pairs["channel"])).tolist()) <= self.channels.keys():
            raise DamagedPartError("its index does not name all channels")
