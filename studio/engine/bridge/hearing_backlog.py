"""Backlog: what a browser could not be sent yet, as much of it as is of worth, and no more."""

from __future__ import annotations

from collections import OrderedDict, deque
from typing import TYPE_CHECKING, Final

from studio.engine.bridge.hearing_frames import Chunk, frame_of

if TYPE_CHECKING:
    from collections.abc import Iterable

KEPT_BYTES: Final = 8 << 20
"""Of channels that keep every message, together; then the oldest are given up and counted."""


class Backlog:
    """Of a channel where only the newest counts it keeps the newest, of the others all it can."""

    def __init__(self) -> None:
        self._newest: OrderedDict[int, Chunk] = OrderedDict()
        self._all: deque[Chunk] = deque()
        self._bytes = 0
        self.dropped = 0
        """Messages that were given up since the beginning."""

    def __bool__(self) -> bool:
        return bool(self._newest or self._all)

    def add(self, chunks: Iterable[Chunk]) -> None:
        """Keep what could not be sent."""
        for chunk in chunks:
            if chunk.keeps_all:
                self._all.append(chunk)
                self._bytes += len(chunk.data)
            else:
                self._newest[chunk.channel] = chunk
        while self._bytes > KEPT_BYTES and self._all:
            given_up = self._all.popleft()
            self._bytes -= len(given_up.data)
            self.dropped += given_up.count

    def frame(self) -> bytes:
        """Take all out, as one frame."""
        chunks = (*self._all, *self._newest.values())
        self._all.clear()
        self._newest.clear()
        self._bytes = 0
        return frame_of(chunks, self.dropped)
