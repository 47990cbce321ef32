"""An Inbox: what came on one line of a relay and is not opened yet, in a thread of its own."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from studio.server.relays.line import Line

_BYTES_MAX: Final = 32 << 20
_COUNT_MAX: Final = 16_384
_LOOK_EVERY_S: Final = 1.0


class Inbox:
    """Keeps who reads for all lines from waiting for one of them.

    Of more than is kept the oldest are dropped: the line notices, and ends. It ends with its line.
    """

    def __init__(self, line: Line) -> None:
        self.line = line
        self._waiting: deque[bytes] = deque()
        self._bytes = 0
        self._came = threading.Condition()
        threading.Thread(target=self._run, name="relay-inbox", daemon=True).start()

    def put(self, sealed: list[bytes]) -> None:
        """Take what came, without waiting; in any thread."""
        with self._came:
            self._waiting.extend(sealed)
            self._bytes += sum(map(len, sealed))
            while self._bytes > _BYTES_MAX or len(self._waiting) > _COUNT_MAX:
                self._bytes -= len(self._waiting.popleft())
            self._came.notify()

    def close(self) -> None:
        """End soon: its line has ended."""
        with self._came:
            self._came.notify()

    def _run(self) -> None:
        while not self.line.closed:
            with self._came:
                if not self._waiting:
                    self._came.wait(_LOOK_EVERY_S)
                taken, self._waiting, self._bytes = self._waiting, deque(), 0
            self.line.feed(taken)
