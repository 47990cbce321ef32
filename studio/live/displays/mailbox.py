"""Mailbox: messages on their way from the wire's thread to the loop."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.displays.display import Received

_KEPT_MAX: Final = 1_000
_BYTES_MAX: Final = 64 << 20
_RATE_OVER_NS: Final = 2_000_000_000
_ARRIVALS: Final = 400


class Mailbox:
    """Keeps the newest message, or every one up to a bound; what falls out is counted."""

    def __init__(self, *, newest_only: bool) -> None:
        self._lock = threading.Lock()
        self._waiting: deque[Received] = deque()
        self._bytes = 0
        self._most = 1 if newest_only else _KEPT_MAX
        self._arrivals_ns: deque[int] = deque(maxlen=_ARRIVALS)
        self._counts_loss = not newest_only
        self.lost = 0
        self.heard = 0

    def post(self, received: Received) -> None:
        """Put in one that came; of any thread."""
        with self._lock:
            self._waiting.append(received)
            self._bytes += len(received.cdr)
            self._arrivals_ns.append(received.received_ns)
            self.heard += 1
            while len(self._waiting) > self._most or self._holds_too_much:
                self._bytes -= len(self._waiting.popleft().cdr)
                self.lost += self._counts_loss

    def take(self) -> Iterator[Received]:
        """Take them out one by one, the oldest first: what is not asked for stays."""
        while self._waiting:
            with self._lock:
                if not self._waiting:
                    return
                received = self._waiting.popleft()
                self._bytes -= len(received.cdr)
            yield received

    def rate_hz(self, now_ns: int) -> float:
        """Messages in a second, of late."""
        with self._lock:
            late = [at for at in self._arrivals_ns if now_ns - at <= _RATE_OVER_NS]
        if len(late) < 2 or late[-1] <= late[0]:
            return 0.0
        return (len(late) - 1) * 1e9 / (late[-1] - late[0])

    def age_ns(self, now_ns: int) -> int | None:
        """How long ago the last one came; None: none did."""
        with self._lock:
            return now_ns - self._arrivals_ns[-1] if self._arrivals_ns else None

    @property
    def _holds_too_much(self) -> bool:
        return len(self._waiting) > 1 and self._bytes > _BYTES_MAX
