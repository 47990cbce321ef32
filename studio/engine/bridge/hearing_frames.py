"""Frames of the data lane: many messages of many topics, as they came, in one binary message.

All numbers are little-endian. A frame begins with 16 bytes: version, three of nothing, how many
messages follow, how many this browser was too slow for since it came, four of nothing. Each
message begins with 28 bytes: channel, length, when it came and when it was sent (ns since the Unix
epoch), how many of its channel were lost on their way so far. Then come its bytes, filled up to a
multiple of 8: so the body of its CDR lies at one, and arrays need not be copied to be read.
The page reads them in `frontend_assets/workers/frames.js`.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.ros.node.inbox import RawSample

VERSION: Final = 1
FRAME_HEAD: Final = struct.Struct("<B3xII4x")
MESSAGE_HEAD: Final = struct.Struct("<IIqqI")
_FILLING: Final = tuple(bytes(count) for count in range(8))
_LOST_MOD: Final = 1 << 32


@dataclass(frozen=True, slots=True)
class Chunk:
    """What came on one channel since the last tick, ready to be sent to any number of browsers."""

    channel: int
    count: int
    data: bytes
    keeps_all: bool
    """Whether older ones are of worth, too, once there is a newer one."""


def chunk_of(channel: int, samples: Sequence[RawSample], lost: int, *, keeps_all: bool) -> Chunk:
    """Write the messages of one channel."""
    parts: list[bytes] = []
    for payload, attachment, received_ns in samples:
        length = len(payload)
        sent_ns = attachment.source_time_ns
        parts += (
            MESSAGE_HEAD.pack(channel, length, received_ns, sent_ns, lost % _LOST_MOD),
            payload,
            _FILLING[-(MESSAGE_HEAD.size + length) % 8],
        )
    return Chunk(channel, len(samples), b"".join(parts), keeps_all)


def frame_of(chunks: Iterable[Chunk], dropped: int) -> bytes:
    """Write the frame of one browser that was too slow for so many messages."""
    chosen = tuple(chunks)
    head = FRAME_HEAD.pack(VERSION, sum(one.count for one in chosen), dropped % _LOST_MOD)
    return b"".join((head, *(one.data for one in chosen)))


class Tick:
    """What one tick brings to all who hear the same channels; its frame is written once."""

    def __init__(self, chunks: tuple[Chunk, ...]) -> None:
        self.chunks = chunks

    @cached_property
    def frame(self) -> bytes:
        """For a browser that was never too slow."""
        return frame_of(self.chunks, 0)
