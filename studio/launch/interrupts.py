"""Signals that end a launch, also where the launch file's own code does not let go."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable

_HELD_S: Final = 15.0
"""So long after the first Ctrl-C is waited for code that does not let go."""
_HELD_AGAIN_S: Final = 3.0
"""After a second one, and after a signal that is no Ctrl-C."""


def ending_signals() -> tuple[int, ...]:
    """Return the signals that end a launch; one that is ignored, as nohup has it, is none."""
    names = ("SIGINT", "SIGTERM", "SIGHUP")
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    return tuple(one for one in numbers if signal.getsignal(one) is not signal.SIG_IGN)


class Interrupts:
    """Hears signals on a thread, for code of a launch file may hold the main one.

    Args:
        heard: Called on that thread with each signal; it has the main thread call `taken`.
        give_up: Called on that thread where nobody took a signal in time; it ends the process.
    """

    def __init__(self, heard: Callable[[int], None], give_up: Callable[[], None]) -> None:
        self._heard, self._give_up = heard, give_up
        self._taken = threading.Event()
        self._over = threading.Event()
        self._reads, self._writes = os.pipe()
        os.set_blocking(self._writes, False)
        self._before = signal.set_wakeup_fd(self._writes, warn_on_full_buffer=False)
        self._numbers = ending_signals()
        self._handlers = {number: signal.getsignal(number) for number in self._numbers}
        threading.Thread(target=self._hear, daemon=True).start()

    def begin(self) -> None:
        """Leave all to the thread: a signal raises nothing any more in the main thread."""
        for number in self._numbers:
            signal.signal(number, lambda *_: None)

    def taken(self) -> None:
        """Say that the last signal has come to the main thread."""
        self._taken.set()

    def close(self) -> None:
        """Give the signals back."""
        self._over.set()
        self._taken.set()
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(self._before)
        os.close(self._writes)  # the end of its pipe ends the thread

    def _hear(self) -> None:
        heard_before = False
        with contextlib.suppress(OSError):
            while data := os.read(self._reads, 64):
                for number in data:
                    if number not in self._numbers:
                        continue
                    self._taken.clear()
                    again = heard_before or number != signal.SIGINT
                    heard_before = True
                    self._heard(number)
                    self._wait(_HELD_AGAIN_S if again else _HELD_S)
        os.close(self._reads)

    def _wait(self, seconds: float) -> None:
        """Give up after some seconds; a later signal may have it do so sooner."""
        if self._over.is_set():
            return

        def look() -> None:
            if not self._taken.is_set():
                self._give_up()

        timer = threading.Timer(seconds, look)
        timer.daemon = True
        timer.start()
