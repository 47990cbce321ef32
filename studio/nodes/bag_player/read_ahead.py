"""ReadAhead: the messages that come next, read by a thread of its own before they are due."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Final

from studio.errors import BagError
from studio.ros.condition import Condition

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.bags.recording import Recorded

BYTES_MAX: Final = 64_000_000
"""Of the payloads that wait: a thousand images would be gigabytes."""
_REFILL: Final = 0.9
"""As rosbag2: read again when so much of the queue is left, not for each message."""


class ReadAhead:
    """Keeps at most so many messages ready; all but `join` is called with its lock held.

    Args:
        lock: What its user holds when it asks.
        arrived: On that lock; notified when the first of those that wait came, and at the end.
        messages: Read in the thread.
        most: How many wait.
    """

    def __init__(
        self,
        lock: threading.Lock,
        arrived: Condition,
        messages: Iterator[Recorded],
        most: int,
    ) -> None:
        self._lock, self._arrived, self._room = lock, arrived, Condition(lock)
        self._messages, self._most = messages, max(1, most)
        self._waiting: deque[Recorded] = deque()
        self._bytes = 0
        self._is_closed = self._is_read = False
        self._failure: BagError | None = None
        self._thread = threading.Thread(target=self._run, name="bag-read-ahead", daemon=True)
        self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether none waits, and none will."""
        return self._is_read and not self._waiting

    @property
    def is_alive(self) -> bool:
        """Whether its thread has not ended."""
        return self._thread.is_alive()

    @property
    def is_filled(self) -> bool:
        """Whether as many wait as may, or as there are."""
        return self._is_read or self._is_full()

    def head(self) -> Recorded | None:
        """Return the next message; None: none waits now.

        Raises:
            BagError: The recording could not be read further than to here.
        """
        if self._waiting:
            return self._waiting[0]
        if self._failure is not None:
            raise self._failure
        return None

    def pop(self) -> None:
        """Take out the next message."""
        self._bytes -= len(self._waiting.popleft().sample.payload)
        if len(self._waiting) <= self._most * _REFILL and self._bytes <= BYTES_MAX * _REFILL:
            self._room.notify()

    def close(self) -> None:
        """Read no more; again is harmless."""
        self._is_closed = True
        self._room.notify()

    def join(self) -> None:
        """Wait until nothing is read any more; without the lock."""
        self._thread.join()

    def _is_full(self) -> bool:
        return len(self._waiting) >= self._most or self._bytes >= BYTES_MAX

    def _run(self) -> None:
        try:
            for one in self._messages:
                if not self._put(one):
                    return
        except BagError as error:
            self._failure = error
        finally:
            with self._lock:
                self._is_read = True
                self._arrived.notify_all()

    def _put(self, one: Recorded) -> bool:
        with self._lock:
            while self._is_full() and not self._is_closed:
                self._room.wait()
            if self._is_closed:
                return False
            self._waiting.append(one)
            self._bytes += len(one.sample.payload)
            if len(self._waiting) == 1 or self._is_full():
                self._arrived.notify_all()
        return True
