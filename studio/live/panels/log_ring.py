"""LogRing: the newest of what nodes said, by number; written by one thread, read by the loop."""

from __future__ import annotations

import itertools
import threading
from collections import deque
from typing import TYPE_CHECKING, Final

from studio.protocol.logs import LINES_MAX, LogLine
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.ros.types.classes import MessageValue

KEPT_MAX: Final = 10_000
CHARACTERS_MAX: Final = 8_000_000
"""Of all lines together; the oldest go."""
TEXT_MAX: Final = 20_000
_NAME_MAX: Final = 500
_WARNING: Final = 30


class LogRing:
    """Any thread may use it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: deque[LogLine] = deque()
        self._characters = 0
        self._numbers = itertools.count(1)

    def take(self, said: MessageValue) -> None:
        """Keep a `rcl_interfaces/msg/Log`; of a text that is too long, its beginning."""
        with self._lock:
            line = _line(next(self._numbers), said)
            self._lines.append(line)
            self._characters += _size(line)
            while len(self._lines) > KEPT_MAX or self._characters > CHARACTERS_MAX:
                self._characters -= _size(self._lines.popleft())

    def after(self, number: int) -> tuple[tuple[LogLine, ...], int, int]:
        """Give the oldest lines after that one, and the numbers of the oldest and newest kept."""
        with self._lock:
            if not self._lines:
                return (), 0, 0
            first, last = self._lines[0].number, self._lines[-1].number
            begin = max(0, number + 1 - first)
            lines = tuple(itertools.islice(self._lines, begin, begin + LINES_MAX))
            return lines, first, last

    @property
    def last(self) -> int:
        """Number of the newest line, 0 without one."""
        with self._lock:
            return self._lines[-1].number if self._lines else 0

    def newest_warning(
        self, loggers: Iterable[str], *, after: int, since_s: float
    ) -> LogLine | None:
        """Give the newest warning or error of some loggers, or of those below them.

        It came after the line of that number, and was not said before `since_s`: who joins late
        is told what was said earlier, too.
        """
        wanted = tuple(loggers)
        with self._lock:
            for line in reversed(self._lines):
                if line.number <= after:
                    return None
                is_grave = line.level >= _WARNING and line.stamp_s >= since_s
                if is_grave and any(f"{line.node}.".startswith(f"{one}.") for one in wanted):
                    return line
        return None


def _line(number: int, said: MessageValue) -> LogLine:
    return LogLine(
        number=number,
        stamp_s=said.stamp.sec + said.stamp.nanosec / NANOSECONDS,
        level=said.level,
        node=said.name[:_NAME_MAX],
        text=_clipped(said.msg),
        file=said.file[:_NAME_MAX],
        function=said.function[:_NAME_MAX],
        line=said.line,
    )


def _clipped(text: str) -> str:
    return text if len(text) <= TEXT_MAX else f"{text[:TEXT_MAX]} …"


def _size(line: LogLine) -> int:
    return len(line.text) + len(line.node) + len(line.file) + len(line.function)
