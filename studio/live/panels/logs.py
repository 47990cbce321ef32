"""The log of all nodes: `/rosout`, received from the first request on."""

from __future__ import annotations

import asyncio
import itertools
import threading
from collections import deque
from typing import TYPE_CHECKING, Final

from studio.live.topics.request import Request
from studio.live.topics.source import decoder
from studio.protocol.commands import Commands, Scope
from studio.protocol.logs import LINES_MAX, GetLog, LogAnswer, LogLine
from studio.ros.duration import NANOSECONDS
from studio.ros.names import logger_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.live.topics.source import TopicSource
    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample
    from studio.ros.types.classes import MessageValue

KEPT_MAX: Final = 10_000
CHARACTERS_MAX: Final = 8_000_000
"""Limit of all lines together; the oldest go."""
TEXT_MAX: Final = 20_000
_NAME_MAX: Final = 500
_WARNING: Final = 30


class LogRing:
    """The newest lines, by number; thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: deque[LogLine] = deque()
        self._characters = 0
        self._numbers = itertools.count(1)

    def take(self, entry: MessageValue) -> None:
        """Keep a `rcl_interfaces/msg/Log`; of a text that is too long, its beginning."""
        with self._lock:
            line = _line(next(self._numbers), entry)
            self._lines.append(line)
            self._characters += _size(line)
            while len(self._lines) > KEPT_MAX or self._characters > CHARACTERS_MAX:
                self._characters -= _size(self._lines.popleft())

    def after(self, number: int) -> tuple[tuple[LogLine, ...], int, int]:
        """Return the oldest lines after that one, and the numbers of the oldest and newest kept."""
        with self._lock:
            if not self._lines:
                return (), 0, 0
            first, last = self._lines[0].number, self._lines[-1].number
            begin = max(0, number + 1 - first)
            lines = tuple(itertools.islice(self._lines, begin, begin + LINES_MAX))
            return lines, first, last

    def clear(self) -> None:
        """Keep nothing of what came; numbers go on."""
        with self._lock:
            self._lines.clear()
            self._characters = 0

    @property
    def last(self) -> int:
        """Number of the newest line, 0 without one."""
        with self._lock:
            return self._lines[-1].number if self._lines else 0

    def newest_warning(
        self, loggers: Iterable[str], *, after: int, since_s: float
    ) -> LogLine | None:
        """Return the newest warning or error of some loggers, or of those below them.

        It came after the line of that number, and is not older than `since_s`: a late subscriber
        receives earlier lines, too.
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


def _line(number: int, entry: MessageValue) -> LogLine:
    return LogLine(
        number=number,
        stamp_s=entry.stamp.sec + entry.stamp.nanosec / NANOSECONDS,
        level=entry.level,
        node=entry.name[:_NAME_MAX],
        text=_clipped(entry.msg),
        file=entry.file[:_NAME_MAX],
        function=entry.function[:_NAME_MAX],
        line=entry.line,
    )


def _clipped(text: str) -> str:
    return text if len(text) <= TEXT_MAX else f"{text[:TEXT_MAX]} …"


def _size(line: LogLine) -> int:
    return len(line.text) + len(line.node) + len(line.file) + len(line.function)


_TYPE: Final = "rcl_interfaces/msg/Log"
_REQUEST: Final = Request(
    "/rosout", (_TYPE,), latched=True, depth=1_000, usually=(True, True), as_known_here=True
)
"""Nodes keep their last lines for those who come late."""


class NodeLogs:
    """Keeps the newest lines for later pages, also after the connection has ended.

    Of a recording it has those up to where that stands, and no others.

    Args:
        source: The source of topics.
        grew: Called after each new line, in a thread of the source.
    """

    def __init__(self, source: TopicSource, grew: Callable[[], object] | None = None) -> None:
        self._source, self._epoch = source, source.epoch
        self._ring = LogRing()
        self._decode = decoder(source, _TYPE)
        self._subscription: Subscription | None = None
        self._waiting: tuple[Callable[[], object], ...] = () if grew is None else (grew,)
        """Called with each line, in a thread of the source."""

    def log(self, command: GetLog) -> LogAnswer:
        """Return the lines after one; no new ones come while there is no connection."""
        self.listen()
        self._keep_epoch()
        lines, first, last = self._ring.after(command.after)
        return LogAnswer(
            request=command.request,
            connected=self._source.connection != "none",
            lines=lines,
            first=first,
            last=last,
        )

    def listen(self) -> int:
        """Receive lines from now on, and return the number of the newest, 0 without one."""
        if self._subscription is None:
            self._subscription = self._source.subscribe(_REQUEST, take=self._take)
        return self._ring.last

    def close(self) -> None:
        """Receive no more."""
        if self._subscription is not None:
            self._subscription.close()

    async def newest_warning(
        self, nodes: Iterable[str], *, after: int, since_s: float, patience_s: float
    ) -> LogLine | None:
        """Return the newest warning or error of some nodes, by their paths, as `LogRing` does.

        It is waited for; None: none came in time.
        """
        loggers = [logger_name(path) for path in nodes]
        loop, came = asyncio.get_running_loop(), asyncio.Event()

        def wake() -> None:
            if not came.is_set() and not loop.is_closed():
                loop.call_soon_threadsafe(came.set)

        self._waiting = (*self._waiting, wake)
        try:
            async with asyncio.timeout(patience_s):
                while True:
                    came.clear()  # before the search: what comes from now on wakes again
                    last = self._ring.last
                    found = self._ring.newest_warning(loggers, after=after, since_s=since_s)
                    if found is not None:
                        return found
                    after = last
                    await came.wait()
        except TimeoutError:
            return None
        finally:
            self._waiting = tuple(one for one in self._waiting if one is not wake)

    def _keep_epoch(self) -> None:
        """Keep nothing of a recording that is of another moment."""
        if not self._source.is_live and self._epoch != self._source.epoch:
            self._epoch = self._source.epoch
            self._ring.clear()

    def _take(self, sample: RawSample) -> None:
        self._keep_epoch()
        self._ring.take(self._decode(sample))
        for wake in self._waiting:
            wake()


COMMANDS: Final = Commands[NodeLogs](Scope.ROS)
COMMANDS.viewer(GetLog, lambda one, c, _: one.log(c))
