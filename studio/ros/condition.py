"""A condition whose wait may be interrupted by Ctrl-C at any moment."""

from __future__ import annotations

import threading


class Condition(threading.Condition):
    """As Python's, but its lock is held again after an interrupted wait.

    Python's own may be interrupted after it gave its lock back and before it took it again. The
    `with` around the wait then raises "cannot release un-acquired lock" in place of the
    KeyboardInterrupt, which a program that expects Ctrl-C does not catch.
    """

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until notified, or that long; whether it was notified."""
        try:
            return super().wait(timeout)
        except BaseException:
            try:
                self.notify(0)  # refused to whoever does not hold the lock
            except RuntimeError:
                self.acquire()
            raise
