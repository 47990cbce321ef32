"""The index of an MCAP file, made anew where it has none or a damaged one."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.bags import mcap_records
from studio.bags.compression import PART_BYTES_MAX
from studio.bags.mcap_file import chunk_data, scan_entries
from studio.bags.mcap_index import McapBlocks, McapIndex, read_exactly
from studio.bags.mcap_records import (
    HEAD,
    MAGIC,
    MESSAGE_FIELDS_BYTES,
    MESSAGE_HEAD,
    read_channel,
    read_chunk,
    read_metadata_record,
    read_schema,
    records,
)
from studio.errors import DamagedPartError

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.bags.blocks import Definition
    from studio.bags.mcap_records import ChannelRecord, Chunk

_STEP_BYTES: Final = 64 * 2**10
_SEARCH_BYTES: Final = 4 * 2**20
_STRETCH_BYTES: Final = 2**20
"""Messages that stand in no chunk are read so many bytes at a time."""
_SMALL_BYTES_MAX: Final = 4 * 2**20
"""Of a record that is neither chunk, message nor attachment; a larger one is rubbish."""
_DAMAGES_MAX: Final = 10
_CHUNK_FORM: Final = re.compile(
    rb"\x06.{6}\x00\x00.{28}(?:\x04\x00\x00\x00zstd|\x03\x00\x00\x00lz4|\x00\x00\x00\x00.{6}\x00\x00)",
    re.DOTALL,
)
_MESSAGE_FORM: Final = re.compile(rb"\x05.{4}\x00\x00\x00\x00.{22}", re.DOTALL)
_FORM_BYTES: Final = 64


def rebuilt_index(
    handle: int, name: str, reason: str, progress: Callable[[float], None] | None = None
) -> McapIndex:
    """Read a file from its begin, passing over the data of chunks that have message indexes.

    Args:
        handle: The file, open for reading.
        name: As it is called in what is said.
        reason: Why its own index cannot be used.
        progress: Is told the share of the file that was read.

    Raises:
        DamagedPartError: It is no MCAP file, or nothing of it is whole.
        OSError: The disk refuses it.
    """
    made = _Rebuilding(handle, progress)
    made.run()
    blocks = made.found.blocks()
    if not len(blocks.starts) and not made.channels:
        raise DamagedPartError("nothing in it is whole")
    count = sum(made.counts.values())
    troubles = [f"{name}: {reason}; its index was made anew, with {count} messages."]
    troubles += [f"{name}: {one}." for one in made.damages]
    return McapIndex(
        blocks.by_begin(),
        made.schemas,
        made.channels,
        made.counts,
        made.metadata,
        tuple(troubles),
    )


class _Window:
    """Reads small parts of a file, one after another, from one larger part at a time."""

    def __init__(self, handle: int) -> None:
        self._handle = handle
        self.size = os.fstat(handle).st_size
        self._at, self._data = 0, b""

    def get(self, at: int, length: int) -> bytes:
        """Return a part; shorter where the file ends."""
        begin = at - self._at
        if begin < 0 or begin + length > len(self._data):
            self._at = at
            self._data = os.pread(self._handle, max(length, _STEP_BYTES), at)
            begin = 0
        return self._data[begin : begin + length]

    def whole(self, at: int, length: int) -> bytes:
        """Return a part that may be large.

        Raises:
            DamagedPartError: The file ends before it.
        """
        return (
            self.get(at, length)
            if length <= _STEP_BYTES
            else read_exactly(self._handle, length, at)
        )


@dataclass(slots=True)
class _Found:
    """Blocks, and the channels in them, in the order of the file."""

    heads: list[tuple[int, int, int, int, bool]] = field(
        default_factory=list[tuple[int, int, int, int, bool]]
    )
    """Begin, end, start, length, whether it is a chunk."""
    index_ends: list[int] = field(default_factory=list[int])
    pairs: list[tuple[int, int, int]] = field(default_factory=list[tuple[int, int, int]])

    def add(self, head: tuple[int, int, int, int, bool]) -> int:
        """Add a block, and return its number."""
        self.heads.append(head)
        self.index_ends.append(head[2] + head[3])
        return len(self.heads) - 1

    def blocks(self) -> McapBlocks:
        """Return them as arrays."""
        heads = np.array(self.heads, np.int64).reshape(-1, 5)
        pairs = np.array(self.pairs, np.int64).reshape(-1, 3)
        return McapBlocks(
            heads[:, 0],
            heads[:, 1],
            heads[:, 2],
            heads[:, 3],
            np.array(self.index_ends, np.int64),
            heads[:, 4].astype(np.bool_),
            pairs[:, 0],
            pairs[:, 1].astype(np.int32),
            pairs[:, 2],
        )


class _Rebuilding:
    """One way through a file, record by record."""

    def __init__(self, handle: int, progress: Callable[[float], None] | None) -> None:
        self._window, self._progress = _Window(handle), progress
        self.schemas: dict[int, Definition] = {}
        self.channels: dict[int, ChannelRecord] = {}
        self.counts: dict[int, int] = {}
        self.metadata: dict[str, str] = {}
        self.found = _Found()
        self.damages: list[str] = []
        self._open: tuple[int, Chunk] | None = None
        """The last chunk and where it begins, until it is known what is in it."""
        self._indexed: list[tuple[int, int, int]] = []
        """Channel, place and count of the message indexes after it."""
        self._told = 0

    def run(self) -> None:
        """Go through the file."""
        at, size = 0, self._window.size
        if self._window.get(0, len(MAGIC)) == MAGIC:
            at = len(MAGIC)
        while at < size:
            self._tell(at)
            try:
                following = self._record(at)
            except DamagedPartError as error:
                following = self._after_damage(at, error.reason)
            if following is None:
                break
            at = following
        self._close_chunk()

    def _tell(self, at: int) -> None:
        if self._progress is not None and at - self._told >= self._window.size // 200:
            self._told = at
            self._progress(at / self._window.size)

    # A record

    def _record(self, at: int) -> int | None:
        """Take a record, and return where the next begins; None: there is none.

        Raises:
            DamagedPartError: It is none.
        """
        head = self._window.get(at, HEAD.size)
        if len(head) < HEAD.size:
            raise DamagedPartError("it is cut off in the middle of a record")
        opcode, length = HEAD.unpack(head)
        end = at + HEAD.size + length
        if opcode == mcap_records.CHUNK:
            self._chunk(at, end)
            return end
        if end > self._window.size:
            raise DamagedPartError("it is cut off in the middle of a record")
        if opcode != mcap_records.MESSAGE_INDEX:
            self._close_chunk()
        return self._small(opcode, at, end)

    def _small(self, opcode: int, at: int, end: int) -> int | None:
        match opcode:
            case mcap_records.MESSAGE_INDEX:
                self._index(at, end)
            case mcap_records.MESSAGE:
                return self._stretch(at)
            case mcap_records.DATA_END | mcap_records.FOOTER:
                return None
            case mcap_records.SCHEMA | mcap_records.CHANNEL | mcap_records.METADATA:
                self._definition(opcode, self._content(at, end))
            case mcap_records.HEADER | mcap_records.ATTACHMENT:
                pass
            case _ if opcode not in mcap_records.OPCODES and opcode < mcap_records.PRIVATE:
                raise DamagedPartError("there is rubbish")
            case _:
                pass
        return end

    def _content(self, at: int, end: int) -> bytes:
        if end - at > _SMALL_BYTES_MAX:
            raise DamagedPartError("there is rubbish")
        return self._window.whole(at + HEAD.size, end - at - HEAD.size)

    def _definition(self, opcode: int, content: bytes | memoryview) -> None:
        match opcode:
            case mcap_records.SCHEMA:
                schema = read_schema(content)
                self.schemas.setdefault(schema.key, schema.definition)
            case mcap_records.CHANNEL:
                channel = read_channel(content)
                self.channels.setdefault(channel.key, channel)
            case _:
                self.metadata |= read_metadata_record(content)

    # Chunks

    def _chunk(self, at: int, end: int) -> None:
        self._close_chunk()
        head = read_chunk(self._window.get(at, mcap_records.CHUNK_HEAD_BYTES))
        self._open = (at, head)
        if end > self._window.size:
            self._cut_chunk(at, head)
            raise DamagedPartError("it is cut off in the middle of a chunk")

    def _cut_chunk(self, at: int, head: Chunk) -> None:
        """Take what can be read of the last chunk, whose end is missing."""
        self._open = None
        self._scan(at, self._window.size - at, head, is_cut=True)

    def _index(self, at: int, end: int) -> None:
        """Take the message index of a channel; in front of it is the chunk, or others."""
        if self._open is None or end - at < HEAD.size + 6:
            raise DamagedPartError("there is an index that belongs to no chunk")
        fields = self._window.get(at + HEAD.size, 6)
        channel = int.from_bytes(fields[:2], "little")
        size = int.from_bytes(fields[2:], "little")
        if size > end - at - HEAD.size - 6 or size % 16:
            raise DamagedPartError("there is a damaged index")
        if size:
            self._indexed.append((channel, at, size // 16))

    def _close_chunk(self) -> None:
        """Take the last chunk by its message indexes; where they tell too little, by its data."""
        if self._open is None:
            return
        at, head = self._open
        self._open, indexed, self._indexed = None, self._indexed, []
        length = head.data_at + head.stored
        is_known = all(channel in self.channels for channel, _, _ in indexed)
        if not indexed or not is_known:
            self._scan(at, length, head, is_cut=False)
            return
        block = self.found.add((head.begin_ns, head.end_ns, at, length, True))
        last = indexed[-1]
        self.found.index_ends[block] = last[1] + HEAD.size + 6 + last[2] * 16
        for channel, place, count in indexed:
            self.found.pairs.append((channel, block, place))
            self._count(channel, count)

    def _scan(self, at: int, length: int, head: Chunk, *, is_cut: bool) -> None:
        """Take a chunk by looking at all that is in it."""
        if not head.size:
            return
        try:
            data = chunk_data(self._window.whole(at, length))
        except DamagedPartError as error:
            if not is_cut:
                self._damage(at, f"a chunk is lost: {error.reason}")
            return
        self._definitions_in(data)
        self._take_entries(data, (at, length), is_chunk=True)

    def _definitions_in(self, data: bytes) -> None:
        view = memoryview(data)
        try:
            for opcode, begin, end in records(data):
                if opcode in (mcap_records.SCHEMA, mcap_records.CHANNEL):
                    self._definition(opcode, view[begin:end])
        except DamagedPartError:
            return  # what comes before it was taken

    def _take_entries(self, data: bytes, place: tuple[int, int], *, is_chunk: bool) -> None:
        entries = scan_entries(data)
        if not entries:
            return
        begin_ns = min(int(one.times_ns[0]) for one in entries.values())
        end_ns = max(int(one.times_ns[-1]) for one in entries.values())
        block = self.found.add((begin_ns, end_ns, *place, is_chunk))
        for channel, found in entries.items():
            self.found.pairs.append((channel, block, 0))
            self._count(channel, len(found.times_ns))

    def _count(self, channel: int, count: int) -> None:
        self.counts[channel] = self.counts.get(channel, 0) + count

    # Messages that stand in no chunk

    def _stretch(self, at: int) -> int:
        """Take the messages up to the next other record, or as many as are read at once."""
        end = at
        while end - at < _STRETCH_BYTES:
            opcode, length = self._head(end)
            after = end + HEAD.size + length
            if opcode != mcap_records.MESSAGE or after > self._window.size:
                break
            if not MESSAGE_FIELDS_BYTES <= length <= PART_BYTES_MAX:
                break
            end = after
        if end == at:
            raise DamagedPartError("there is rubbish")
        self._take_entries(self._window.whole(at, end - at), (at, end - at), is_chunk=False)
        return end

    def _head(self, at: int) -> tuple[int, int]:
        head = self._window.get(at, HEAD.size)
        return HEAD.unpack(head) if len(head) == HEAD.size else (0, 0)

    # Damage

    def _damage(self, at: int, sentence: str) -> None:
        if len(self.damages) < _DAMAGES_MAX:
            self.damages.append(f"at byte {at}, {sentence}")

    def _after_damage(self, at: int, reason: str) -> int | None:
        """Look for the next record that is one; None: there is none."""
        self._close_chunk()
        found = self._next_record(at + 1)
        if found is None:
            self._damage(at, reason)
        else:
            self._damage(at, f"{found - at} bytes are rubbish and left out")
        return found

    def _next_record(self, at: int) -> int | None:
        """Return where the next chunk begins or, in a file without chunks, the next message."""
        in_chunks = any(head[4] for head in self.found.heads) or not self.found.heads
        form = _CHUNK_FORM if in_chunks else _MESSAGE_FORM
        is_one = self._is_chunk if in_chunks else self._is_message
        while at < self._window.size:
            self._tell(at)
            data = self._window.get(at, _SEARCH_BYTES)
            begin = 0
            while match := form.search(data, begin):
                if is_one(at + match.start()):
                    return at + match.start()
                begin = match.start() + 1
            at += max(1, len(data) - _FORM_BYTES) if len(data) == _SEARCH_BYTES else _SEARCH_BYTES
        return None

    def _is_chunk(self, at: int) -> bool:
        try:
            head = read_chunk(self._window.get(at, mcap_records.CHUNK_HEAD_BYTES))
        except DamagedPartError:
            return False
        end = at + head.data_at + head.stored
        return head.begin_ns <= head.end_ns and end <= self._window.size

    def _is_message(self, at: int) -> bool:
        head = self._window.get(at, MESSAGE_HEAD.size)
        if len(head) < MESSAGE_HEAD.size:
            return False
        _opcode, length, channel, *_ = MESSAGE_HEAD.unpack(head)
        end = at + HEAD.size + length
        if channel not in self.channels or length < MESSAGE_FIELDS_BYTES or end > self._window.size:
            return False
        return end == self._window.size or self._window.get(end, 1)[0] in mcap_records.OPCODES
