"""Frames of the data lane: many messages of many topics in one binary message.

All numbers are little-endian. A frame begins with 16 bytes: version, three zero bytes, the number
of messages, the number of messages dropped since the browser came because it was too slow, four
zero bytes. Each message begins with 28 bytes: channel, length, times of arrival and sending (ns
since the Unix epoch), number of messages of its channel lost so far. Then come its bytes, padded to
a multiple of 8, so that the body of its CDR is aligned and arrays can be read without a copy.
The page reads them in `frontend_assets/workers/frames.js`. The bulk lane carries the same frames.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.ros.node.samples import RawSample

VERSION: Final = 1
LARGE_BYTES: Final = 256 << 10
"""Longer messages go by the bulk lane where a browser has one."""
FRAME_HEAD: Final = struct.Struct("<B3xII4x")
MESSAGE_HEAD: Final = struct.Struct("<IIqqI")
_FILLING: Final = tuple(bytes(count) for count in range(8))
_LOST_MOD: Final = 1 << 32


@dataclass(frozen=True, slots=True)
class Chunk:
    """The messages of one channel since the last tick, ready to be sent to several browsers."""

    channel: int
    count: int
    parts: tuple[bytes, ...]
    """To be sent one after the other: large messages are not copied."""
    size: int
    """Bytes of all parts."""
    keeps_all: bool
    """Whether older ones are of worth, too, once there is a newer one."""

    @property
    def is_large(self) -> bool:
        """Whether its messages are for the bulk lane."""
        return self.size > LARGE_BYTES * self.count


def chunk_of(channel: int, samples: Sequence[RawSample], lost: int, *, keeps_all: bool) -> Chunk:
    """Write the messages of one channel."""
    parts: list[bytes] = []
    lost %= _LOST_MOD
    for payload, attachment, received_ns in samples:
        length = len(payload)
        head = MESSAGE_HEAD.pack(channel, length, received_ns, attachment.source_time_ns, lost)
        parts += (head, payload, _FILLING[-(MESSAGE_HEAD.size + length) % 8])
    size = sum(map(len, parts))
    is_small = size <= LARGE_BYTES * len(samples)
    joined = (b"".join(parts),) if is_small else tuple(parts)
    return Chunk(channel, len(samples), joined, size, keeps_all)


def frame_parts(chunks: Sequence[Chunk], dropped: int) -> list[bytes]:
    """Return the frame of these, in parts that are to be sent one after the other."""
    head = FRAME_HEAD.pack(VERSION, sum(one.count for one in chunks), dropped % _LOST_MOD)
    return [head, *(part for one in chunks for part in one.parts)]


def no_head(_length: int) -> bytes:
    """Put nothing before a frame."""
    return b""


def frame_of(
    chunks: Sequence[Chunk], dropped: int, head: Callable[[int], bytes] = no_head
) -> bytes:
    """Return the frame of one browser that was too slow for so many messages.

    `head` makes of the frame's length what goes before it, so that all is copied once.
    """
    length = FRAME_HEAD.size + sum(one.size for one in chunks)
    return b"".join((head(length), *frame_parts(chunks, dropped)))


class Tick:
    """The messages of one tick for all who subscribe to the same channels; written once.

    `kept_for` is the subscription whose latched messages these are; -1: they came just now.
    """

    def __init__(self, chunks: tuple[Chunk, ...], kept_for: int = -1) -> None:
        self.chunks, self.kept_for = chunks, kept_for
        self._without: dict[frozenset[int], Tick] = {}
        self._frames: dict[Callable[[int], bytes], bytes] = {}

    def frame(self, head: Callable[[int], bytes] = no_head) -> bytes:
        """Return the frame of a browser that was never too slow, with what `head` puts before."""
        if head not in self._frames:
            self._frames[head] = frame_of(self.chunks, 0, head)
        return self._frames[head]

    @cached_property
    def large(self) -> frozenset[int]:
        """Channels whose messages are for the bulk lane."""
        return frozenset(one.channel for one in self.chunks if one.is_large)

    def without(self, channels: frozenset[int]) -> Tick:
        """Return the rest, once for all who have these from elsewhere."""
        if channels not in self._without:
            left = tuple(one for one in self.chunks if one.channel not in channels)
            self._without[channels] = self if len(left) == len(self.chunks) else Tick(left)
        return self._without[channels]
