"""Reads frames of the data lane that came over a line, without decoding the messages in them."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.errors import RelayLineError
from studio.live.topics.frames import FRAME_HEAD, LARGE_BYTES, MESSAGE_HEAD, VERSION, Chunk

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_BEGIN: Final = struct.Struct("<II")
"""Of a message's head: its channel and its length."""
_LOST: Final = struct.Struct("<I")
_LOST_AT: Final = MESSAGE_HEAD.size - _LOST.size
_LOST_MOD: Final = 1 << 32


def chunks_of_frame(frame: bytes, keeps_all: Mapping[int, bool]) -> dict[int, Chunk]:
    """Return the messages of a frame by channel, as the bytes that came.

    Args:
        frame: As `studio.live.topics.frames` writes it.
        keeps_all: Of each channel that is known; messages of others are left out.

    Raises:
        RelayLineError: It is no such frame.
    """
    found: dict[int, _Found] = {}
    for channel, count, begin, end in _runs(frame):
        if channel in keeps_all:
            one = found.setdefault(channel, _Found())
            one.parts.append(frame[begin:end])
            one.count += count
            one.size += end - begin
    return {
        channel: Chunk(channel, one.count, one.joined, one.size, keeps_all[channel])
        for channel, one in found.items()
    }


def with_lost(chunk: Chunk, more: int) -> Chunk:
    """Return a chunk whose messages say that so many more of their channel were lost."""
    data = bytearray().join(chunk.parts)
    at = 0
    while at < len(data):
        _, length = _BEGIN.unpack_from(data, at)
        (lost,) = _LOST.unpack_from(data, at + _LOST_AT)
        _LOST.pack_into(data, at + _LOST_AT, (lost + more) % _LOST_MOD)
        at += MESSAGE_HEAD.size + length + -(MESSAGE_HEAD.size + length) % 8
    return Chunk(chunk.channel, chunk.count, (bytes(data),), chunk.size, chunk.keeps_all)


@dataclass(slots=True)
class _Found:
    """Messages of one channel, as parts of a frame."""

    count: int = 0
    size: int = 0
    parts: list[bytes] = field(default_factory=list[bytes])

    @property
    def joined(self) -> tuple[bytes, ...]:
        is_small = self.size <= LARGE_BYTES * self.count
        return (b"".join(self.parts),) if is_small and len(self.parts) > 1 else tuple(self.parts)


def _runs(frame: bytes) -> Iterator[tuple[int, int, int, int]]:
    """Yield the messages of one channel that follow each other: their count, begin and end."""
    size = len(frame)
    if size < FRAME_HEAD.size:
        raise RelayLineError(f"a frame of {size} bytes has no head.")
    version, total, _ = FRAME_HEAD.unpack_from(frame)
    if version != VERSION:
        raise RelayLineError(f"its frames are of version {version}, and not of {VERSION}.")
    begin_of, head = _BEGIN.unpack_from, MESSAGE_HEAD.size
    at = begin = FRAME_HEAD.size
    count, current = 0, -1
    # Each message takes a head at least, so that a forged number ends with the frame.
    for _ in range(total):
        if at + head > size:
            raise RelayLineError("a frame ends before its last message.")
        channel, length = begin_of(frame, at)
        if channel != current:
            if count:
                yield current, count, begin, at
            current, count, begin = channel, 0, at
        count += 1
        at = (at + head + length + 7) & ~7
    if at != size:
        raise RelayLineError("a frame is not as long as its messages.")
    if count:
        yield current, count, begin, at
