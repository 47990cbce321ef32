"""RunLines: the last lines of each process of a run, numbered over all of them."""

from __future__ import annotations

import heapq
from collections import deque
from itertools import islice
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterator

LINES_MAX: Final = 1000
"""Kept of one process: one that chatters takes no line of another one away."""
LINE_MAX: Final = 2000
"""Characters; what is longer goes on as the next line."""
PROCESSES_MAX: Final = 200
"""Whose lines are kept apart; those of all further ones share a place."""
SENT_MAX: Final = 1000
ITSELF: Final = -1
"""The process number of the launch itself."""
_SHARED: Final = -2

Stream: TypeAlias = Literal["stdout", "stderr", "info", "warn", "error"]


class Line(NamedTuple):
    """One line; `number` counts those of the run from 1."""

    number: int
    process: int
    stream: Stream
    text: str


class RunLines:
    """Takes texts as they come, cuts them into lines, and keeps the last ones of each process."""

    def __init__(self) -> None:
        self._rings: dict[int, deque[Line]] = {}
        self._rests: dict[tuple[int, Stream], str] = {}
        self.last = 0
        """Number of the newest line."""
        self.dropped = 0
        """Lines that were too many to keep, as far as they are known."""

    def take(self, process: int, stream: Stream, text: str) -> None:
        """Take what a process wrote; the rest without an end of line waits for more."""
        *lines, rest = (self._rests.pop((process, stream), "") + text).split("\n")
        for line in lines:
            self._keep(process, stream, line.rstrip("\r"))
        while len(rest) >= LINE_MAX:
            self._keep(process, stream, rest[:LINE_MAX])
            rest = rest[LINE_MAX:]
        if rest:
            self._rests[process, stream] = rest

    def say(self, stream: Stream, sentence: str, process: int = ITSELF) -> None:
        """Add a line of the launch itself."""
        self._keep(process, stream, sentence)

    def end(self, process: int | None = None) -> None:
        """Take what stands without an end of line: nothing comes any more, of one or of all."""
        for one, stream in tuple(self._rests):
            if process in {None, one}:
                self.take(one, stream, "\n")

    def after(self, number: int) -> tuple[Line, ...]:
        """Return the kept lines after one, in order, so many at most as are sent at once."""
        later = (_later(ring, number) for ring in self._rings.values())
        return tuple(islice(heapq.merge(*later), SENT_MAX))

    def last_text(self, process: int) -> str:
        """Return the last line of a process that is not blank; empty: none came."""
        ring = self._rings.get(self._place(process), ())
        return next((one.text for one in reversed(ring) if one.text.strip()), "")

    def _keep(self, process: int, stream: Stream, text: str) -> None:
        ring = self._rings.setdefault(self._place(process), deque(maxlen=LINES_MAX))
        for start in range(0, max(1, len(text)), LINE_MAX):
            self.last += 1
            self.dropped += len(ring) == LINES_MAX
            ring.append(Line(self.last, process, stream, text[start : start + LINE_MAX]))

    def _place(self, process: int) -> int:
        if process in self._rings or len(self._rings) < PROCESSES_MAX:
            return process
        return _SHARED


def _later(ring: deque[Line], number: int) -> Iterator[Line]:
    """Yield the lines of a ring after one; the ring is not read from its beginning."""
    count = 0
    for line in reversed(ring):
        if line.number <= number:
            break
        count += 1
    return islice(ring, len(ring) - count, None)
