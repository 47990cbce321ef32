"""An MCAP file, read chunk by chunk; the last chunks are kept, and scanned without a library."""

from __future__ import annotations

import os
import threading
import zlib
from typing import TYPE_CHECKING, Final, Protocol, TypeVar, cast

import numpy as np

from studio.bags.blocks import NO_ENTRIES, Channel, Columns, Entries
from studio.bags.compression import decompressed, decompressed_begin, decompressed_message
from studio.bags.mcap_index import McapIndex, read_exactly
from studio.bags.mcap_records import (
    HEAD,
    MESSAGE,
    MESSAGE_FIELDS_BYTES,
    MESSAGE_HEAD,
    MESSAGE_INDEX,
    as_channel,
    read_chunk,
)
from studio.bags.recording import Recorded
from studio.errors import BagNotReadableError, DamagedPartError
from studio.files import Stamp, stamp_of
from studio.ros.attachment import Attachment
from studio.ros.node.samples import RawSample

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from studio.bags.blocks import BlockTable, Definition, Outline, Scan
    from studio.bags.bounded_cache import BoundedCache

_INDEX_REGION_MAX: Final = 64 * 2**20
_INDEX_HEAD_BYTES: Final = HEAD.size + 6
TROUBLES_MAX: Final = 20
_T = TypeVar("_T")


class _Maker(Protocol):
    """What makes a value of a named tuple."""

    def __call__(self, kind: type[_T], values: tuple[object, ...], /) -> _T:
        """Make it of its fields."""
        ...


_new = cast("_Maker", vars(tuple)["__new__"])
"""Makes a named tuple without the call of its own constructor, which takes as long again."""


class McapFile:
    """One MCAP file; thread-safe.

    Attributes:
        path: Where it lies.
        table: Its blocks.
        channels: By their keys.
        definitions: Its schemas.
        distro: Empty: what recorded it stands in no part that is read here.
    """

    def __init__(
        self,
        path: Path,
        index: McapIndex,
        stamp: Stamp | None,
        caches: tuple[BoundedCache[bytes], BoundedCache[object]],
    ) -> None:
        """Open a file whose index was read.

        Raises:
            BagNotReadableError: It cannot be opened.
        """
        self.path = path
        self.table: BlockTable = index.blocks.table()
        self.channels: Mapping[int, Channel] = {
            key: as_channel(one, index.schemas, index.counts.get(key))
            for key, one in index.channels.items()
        }
        self.definitions: Sequence[Definition] = list(index.schemas.values())
        self.distro = ""
        self.compresses_messages = False
        self._blocks, self._stamp = index.blocks, stamp
        self._chunks, self._indexes = caches
        self._troubles = list(index.troubles)
        self._bad: set[int] = set()
        self._unindexed: set[int] = set()
        self._lock = threading.Lock()
        self._handle = opened(path)

    @property
    def troubles(self) -> Sequence[str]:
        """What is damaged, a sentence each."""
        with self._lock:
            return list(self._troubles)

    def close(self) -> None:
        """Give the file back; nothing may be asked of it afterwards."""
        with self._lock:
            handle, self._handle = self._handle, -1
        if handle >= 0:
            os.close(handle)

    # What is in a block

    def entries(self, block: int, channel: int) -> Entries:
        """Return which messages of a channel lie in a block."""
        presence = self.table.presence.get(channel)
        mark = presence.mark(block) if presence else None
        if mark is None or block in self._bad:
            return NO_ENTRIES
        if mark and block not in self._unindexed:
            try:
                return self._indexed(block, channel, mark)
            except DamagedPartError:
                self._unindexed.add(block)
        return self._found_by_scan(block).get(channel, NO_ENTRIES)

    def _indexed(self, block: int, channel: int, at: int) -> Entries:
        """Read the message index of a channel after a chunk."""
        region, begin = self._index_region(block)
        at -= begin
        if at < 0 or at + _INDEX_HEAD_BYTES > len(region):
            raise DamagedPartError("its index lies elsewhere")
        opcode, length = HEAD.unpack_from(region, at)
        key = int.from_bytes(region[at + 9 : at + 11], "little")
        size = int.from_bytes(region[at + 11 : at + 15], "little")
        begin = at + _INDEX_HEAD_BYTES
        if (
            opcode != MESSAGE_INDEX
            or key != channel
            or size % 16
            or size + 6 > length
            or begin + size > len(region)
        ):
            raise DamagedPartError("its index is damaged")
        pairs = np.frombuffer(region, "<i8", size // 8, begin).reshape(-1, 2)
        return _by_time(pairs[:, 0], pairs[:, 1])

    def _index_region(self, block: int) -> tuple[bytes, int]:
        """Return all message indexes after a chunk, and where they begin in the file."""
        begin = int(self._blocks.starts[block] + self._blocks.lengths[block])
        length = min(int(self._blocks.index_ends[block]) - begin, _INDEX_REGION_MAX)

        def made() -> tuple[object, int]:
            region = self._read(length, begin)
            return region, len(region) + 100

        region = self._indexes.get((self.path, block, "index"), made)
        return cast("bytes", region), begin

    def _found_by_scan(self, block: int) -> dict[int, Entries]:
        """Return which messages of each channel a block holds, by looking at all of it."""

        def made() -> tuple[object, int]:
            found = scan_entries(self._data(block) or b"")
            return found, sum(one.times_ns.nbytes * 2 + 300 for one in found.values())

        found = self._indexes.get((self.path, block, "scan"), made)
        return cast("dict[int, Entries]", found)

    # Its messages

    def sample(self, block: int, channel: int, place: int, gid: bytes) -> RawSample | None:
        """Return one message; None: it is damaged, and `entries` may know better now."""
        data = self._data(block)
        if data is None:
            return None
        found = _message_at(data, channel, place)
        if found is None:
            self._unindexed.add(block)
            return None
        sequence, log_ns, publish_ns, until = found
        payload = data[place + MESSAGE_HEAD.size : until]
        whole = self._whole(payload) if self.compresses_messages else payload
        if whole is None:
            return None
        return RawSample(whole, Attachment(sequence, publish_ns, gid), log_ns)

    def _whole(self, payload: bytes) -> bytes | None:
        try:
            return decompressed_message(payload)
        except DamagedPartError as error:
            self._tell(f"A message of {self.path.name} is left out: {error.reason}.")
            return None

    def scanned(self, block: int, wanted: Mapping[int, Outline], *, keep: bool = True) -> Scan:
        """Return all messages of some channels in a block; those before the first damage."""
        data = self._data(block, keep=keep) or b""
        return McapScan(data, wanted, self._whole if self.compresses_messages else None)

    def columns(self, block: int, channel: int) -> Columns | None:
        """Return the payloads of a channel in a block; None: there are none, or it is damaged."""
        times_ns, places = self.entries(block, channel)
        data = self._data(block) if len(places) else None
        if data is None:
            return None
        count = len(places)
        places, times_ns, lengths = _message_lengths(data, places, times_ns)
        if len(places) < count and block not in self._unindexed:
            self._unindexed.add(block)
            return self.columns(block, channel)
        if self.compresses_messages:
            return self._whole_columns(data, times_ns, places, lengths)
        return Columns(times_ns, data, places + MESSAGE_HEAD.size, lengths)

    def _whole_columns(
        self,
        data: bytes,
        times_ns: NDArray[np.int64],
        places: NDArray[np.int64],
        lengths: NDArray[np.int64],
    ) -> Columns:
        begins = (places + MESSAGE_HEAD.size).tolist()
        parts = [
            self._whole(data[at : at + n]) for at, n in zip(begins, lengths.tolist(), strict=True)
        ]
        kept = np.array([part is not None for part in parts], np.bool_)
        wholes = [part for part in parts if part is not None]
        sizes = np.array([len(part) for part in wholes], np.int64)
        return Columns(times_ns[kept], b"".join(wholes), np.cumsum(sizes) - sizes, sizes)

    # Its bytes

    def _data(self, block: int, *, keep: bool = True) -> bytes | None:
        """Return the records of a block, decompressed; None: it is damaged, which is said."""
        if block in self._bad:
            return None
        try:
            if keep:
                return self._chunks.get((self.path, block), lambda: self._load(block))
            return self._chunks.found((self.path, block)) or self._load(block)[0]
        except DamagedPartError as error:
            self._check_unchanged()
            self._bad.add(block)
            self._tell(self._lost(block, error.reason))
            return None

    def _load(self, block: int) -> tuple[bytes, int]:
        start, length = int(self._blocks.starts[block]), int(self._blocks.lengths[block])
        record = self._read(length, start)
        if not self._blocks.are_chunks[block]:
            return record, length
        data = chunk_data(record)
        return data, len(data)

    def _read(self, length: int, at: int) -> bytes:
        try:
            return read_exactly(self._handle, length, at)
        except OSError as error:
            raise BagNotReadableError(str(self.path), error.strerror or "the disk fails") from None

    def _check_unchanged(self) -> None:
        """Say that a file is another one now, and not that it is damaged.

        Raises:
            BagNotReadableError: It was changed since it was opened.
        """
        if stamp_of(self.path) != self._stamp:
            raise BagNotReadableError(
                str(self.path), "it was changed while it was open; open it again"
            )

    def _lost(self, block: int, reason: str) -> str:
        begin_ns, end_ns = int(self.table.begins_ns[block]), int(self.table.ends_ns[block])
        first_ns = self.table.span_ns[0]
        return (
            f"{self.path.name}: the messages from {(begin_ns - first_ns) / 1e9:.3f} s to "
            f"{(end_ns - first_ns) / 1e9:.3f} s are lost: in their chunk, {reason}."
        )

    def _tell(self, sentence: str) -> None:
        with self._lock:
            if sentence not in self._troubles and len(self._troubles) < TROUBLES_MAX:
                self._troubles.append(sentence)


def opened(path: Path) -> int:
    """Open a file for reading, and return its handle.

    Raises:
        BagNotReadableError: It cannot be opened.
    """
    try:
        return os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0))
    except OSError as error:
        raise BagNotReadableError(str(path), error.strerror or type(error).__name__) from None


def chunk_data(record: bytes) -> bytes:
    """Return the records in a chunk's record; of one that is cut off, those before the cut.

    Raises:
        DamagedPartError: It is no chunk, cannot be decompressed, or has a wrong checksum.
    """
    head = read_chunk(record)
    stored = memoryview(record)[head.data_at : head.data_at + head.stored]
    if len(stored) < head.stored:
        return decompressed_begin(stored, head.compression, head.size)
    data = decompressed(stored, head.compression, head.size)
    if head.crc and zlib.crc32(data) != head.crc:
        raise DamagedPartError("its checksum is wrong")
    return data


def _message_at(data: bytes, channel: int, place: int) -> tuple[int, int, int, int] | None:
    """Return sequence, times and end of a message of a channel; None: there is none."""
    if not 0 <= place <= len(data) - MESSAGE_HEAD.size:
        return None
    opcode, length, key, sequence, log_ns, publish_ns = MESSAGE_HEAD.unpack_from(data, place)
    until = place + HEAD.size + length
    is_whole = place + MESSAGE_HEAD.size <= until <= len(data)
    if opcode != MESSAGE or key != channel or not is_whole:
        return None
    return sequence, log_ns, publish_ns, until


class McapScan:
    """The messages of some channels among records; see `Scan`.

    Attributes:
        times_ns: When each came.
    """

    def __init__(
        self,
        data: bytes,
        wanted: Mapping[int, Outline],
        whole: Callable[[bytes], bytes | None] | None = None,
    ) -> None:
        """Find them, up to the first damage; `whole` decompresses a message."""
        self._data, self._wanted, self._whole = data, wanted, whole
        self._heads: list[tuple[int, ...]] = []
        self._ends: list[int] = []
        take, ends, unpack = self._heads.append, self._ends.append, MESSAGE_HEAD.unpack_from
        at, last = 0, len(data) - MESSAGE_HEAD.size
        while at <= last:
            head = unpack(data, at)
            length = head[1]
            at += 9 + length
            if head[0] == MESSAGE and head[2] in wanted:
                if at > len(data) or length < MESSAGE_FIELDS_BYTES:
                    break
                take(head)
                ends(at)
        self.times_ns = [head[4] for head in self._heads]

    def made(self, numbers: Iterable[int]) -> Iterator[Recorded]:
        """Yield those, without the ones that are damaged."""
        data, wanted, whole, new = self._data, self._wanted, self._whole, _new
        heads, ends = self._heads, self._ends
        for number in numbers:
            _, length, channel, sequence, log_ns, publish_ns = heads[number]
            end = ends[number]
            payload = data[end - length + MESSAGE_FIELDS_BYTES : end]
            if whole is not None and (payload := whole(payload)) is None:
                continue
            topic, gid = wanted[channel]
            attachment = new(Attachment, (sequence, publish_ns, gid))
            sample = new(RawSample, (payload, attachment, log_ns))
            yield new(Recorded, (topic, sample))


def scan_entries(data: bytes) -> dict[int, Entries]:
    """Return which messages of each channel lie among records; to where they are whole."""
    found: dict[int, tuple[list[int], list[int]]] = {}
    unpack, at, last = MESSAGE_HEAD.unpack_from, 0, len(data) - MESSAGE_HEAD.size
    while at <= last:
        opcode, length, channel, _sequence, log_ns, _publish = unpack(data, at)
        end = at + 9 + length
        if opcode == MESSAGE:
            if end > len(data) or length < MESSAGE_FIELDS_BYTES:
                break
            times, places = found.setdefault(channel, ([], []))
            times.append(log_ns)
            places.append(at)
        at = end
    return {
        key: _by_time(np.array(times, np.int64), np.array(places, np.int64))
        for key, (times, places) in found.items()
    }


def _by_time(times_ns: NDArray[np.int64], places: NDArray[np.int64]) -> Entries:
    """Sort messages by time; those of one time as they lie in the file."""
    if np.all(times_ns[1:] >= times_ns[:-1]):
        return Entries(times_ns, places)
    order = np.lexsort((places, times_ns))
    return Entries(times_ns[order], places[order])


def _message_lengths(
    data: bytes, places: NDArray[np.int64], times_ns: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return places, times and payload lengths of those that are whole messages."""
    inside = (places >= 0) & (places <= len(data) - MESSAGE_HEAD.size)
    places, times_ns = places[inside], times_ns[inside]
    raw = np.frombuffer(data, np.uint8)
    spread = raw[places[:, None] + np.arange(1, 9)]
    lengths = spread.copy().view("<i8")[:, 0] - MESSAGE_FIELDS_BYTES
    whole = (
        (raw[places] == MESSAGE)
        & (lengths >= 0)
        & (lengths <= len(data) - places - MESSAGE_HEAD.size)
    )
    return places[whole], times_ns[whole], lengths[whole]
