"""Backlog: what a browser could not be sent yet, as much of it as is of worth, and no more."""

from __future__ import annotations

from collections import OrderedDict, deque
from typing import TYPE_CHECKING, Final

from studio.live.topics.frames import Chunk, frame_of, no_head

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

KEPT_BYTES: Final = 8 << 20
"""For all channels that keep every message; when full, the oldest are dropped and counted."""
NEWEST_BYTES: Final = 24 << 20
"""For all channels where only the newest counts; when full, the oldest is dropped."""


class Backlog:
    """Messages that wait: the newest of a `newest` channel, of the others as many as fit.

    Args:
        gave_up: Called with what is dropped and counted.
    """

    def __init__(self, gave_up: Callable[[Chunk], object] = lambda _: None) -> None:
        self._gave_up = gave_up
        self._newest: OrderedDict[int, Chunk] = OrderedDict()
        self._all: deque[Chunk] = deque()
        self._bytes = self._newest_bytes = 0
        self._was_newest = False
        self.dropped = 0
        """Messages that were given up since the beginning."""

    def __bool__(self) -> bool:
        return bool(self._newest or self._all)

    def add(self, chunks: Iterable[Chunk]) -> None:
        """Keep what could not be sent."""
        for chunk in chunks:
            if chunk.keeps_all:
                self._all.append(chunk)
                self._bytes += chunk.size
            else:
                self._replace(chunk)
        while self._bytes > KEPT_BYTES and len(self._all) > 1:
            given_up = self._all.popleft()
            self._bytes -= given_up.size
            self.dropped += given_up.count
            self._gave_up(given_up)

    def pop(self) -> Chunk:
        """Take one out: the oldest of either kind, in turn, so that neither waits for the other."""
        self._was_newest = bool(self._newest) and not (self._all and self._was_newest)
        if self._was_newest:
            _, chunk = self._newest.popitem(last=False)
            self._newest_bytes -= chunk.size
        else:
            chunk = self._all.popleft()
            self._bytes -= chunk.size
        return chunk

    def take_all(self) -> tuple[Chunk, ...]:
        """Take all out."""
        chunks = (*self._all, *self._newest.values())
        self._all.clear()
        self._newest.clear()
        self._bytes = self._newest_bytes = 0
        return chunks

    def take_of(self, channel: int) -> tuple[Chunk, ...]:
        """Take out what is of one channel."""
        found = [one for one in self._all if one.channel == channel]
        if found:
            self._all = deque(one for one in self._all if one.channel != channel)
            self._bytes -= sum(one.size for one in found)
        if (newest := self._newest.pop(channel, None)) is not None:
            self._newest_bytes -= newest.size
            found.append(newest)
        return tuple(found)

    def frame(self, head: Callable[[int], bytes] = no_head) -> bytes:
        """Take all out, as one frame with what `head` makes of its length before it."""
        return frame_of(self.take_all(), self.dropped, head)

    def _replace(self, chunk: Chunk) -> None:
        if (before := self._newest.pop(chunk.channel, None)) is not None:
            self._newest_bytes -= before.size
        self._newest[chunk.channel] = chunk
        self._newest_bytes += chunk.size
        while self._newest_bytes > NEWEST_BYTES and len(self._newest) > 1:
            _, passed_over = self._newest.popitem(last=False)
            self._newest_bytes -= passed_over.size
