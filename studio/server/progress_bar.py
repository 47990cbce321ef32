"""One line on a terminal for work that takes longer than a second; nothing anywhere else."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TextIO

_DELAY_S: Final = 1.0
_CELLS: Final = 24
_CLEAR: Final = "\r\x1b[K"


class ProgressBar:
    """Draws over itself; `end` leaves the line empty. Thread-safe."""

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream, self._clock = stream, clock
        self._begin_s = clock()
        self._drawn = False

    def show(self, label: str, done: int, total: int) -> None:
        """Show the progress; with `total` 0, unknown, only how many."""
        if not self._stream.isatty() or self._clock() - self._begin_s < _DELAY_S:
            return
        filled = _CELLS * min(done, total) // total if total else 0
        bar = f"[{'#' * filled}{'.' * (_CELLS - filled)}] " if total else ""
        count = f"{done}/{total}" if total else f"{done}"
        self._stream.write(f"{_CLEAR}{bar}{count} {label}")
        self._stream.flush()
        self._drawn = True

    def end(self) -> None:
        """Take the line away."""
        if self._drawn:
            self._stream.write(_CLEAR)
            self._stream.flush()
        self._drawn = False
