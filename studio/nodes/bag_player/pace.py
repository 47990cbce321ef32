"""Pace: the time of a recording while it is played: how fast it goes, and where it stands."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Final

from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Callable

_RATE_MAX: Final = 1e9
"""With it ages pass in a second; the time of far more is no number any longer."""


class Pace:
    """Counts the time of a recording on the steady clock, so that it does not drift.

    Not thread-safe: its owner holds a lock.

    Args:
        at_ns: Where it stands at first, since the Unix epoch.
        rate: Seconds of the recording in a second, above 0.
        is_paused: Whether it stands still at first.
        steady_ns: The steady clock.
    """

    def __init__(
        self,
        at_ns: int,
        rate: float = 1.0,
        *,
        is_paused: bool = False,
        steady_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self._steady_ns = steady_ns
        self._from_ns, self._since_ns = at_ns, steady_ns()
        self._rate, self._is_paused = rate, is_paused

    @property
    def rate(self) -> float:
        """Seconds of the recording in a second."""
        return self._rate

    @property
    def is_paused(self) -> bool:
        """Whether it stands still."""
        return self._is_paused

    def now_ns(self) -> int:
        """Return the time of the recording, since the Unix epoch."""
        if self._is_paused:
            return self._from_ns
        return self._from_ns + round((self._steady_ns() - self._since_ns) * self._rate)

    def left_s(self, at_ns: int) -> float:
        """Return in how many seconds a time comes; 0 if it has come, infinite while it stands."""
        if self._is_paused:
            return math.inf
        due_ns = self._since_ns + (at_ns - self._from_ns) / self._rate
        return max(0.0, (due_ns - self._steady_ns()) / NANOSECONDS)

    def jump(self, at_ns: int) -> None:
        """Go on from another time."""
        self._from_ns, self._since_ns = at_ns, self._steady_ns()

    def pause(self) -> None:
        """Stand still."""
        self.jump(self.now_ns())
        self._is_paused = True

    def resume(self) -> None:
        """Go on."""
        self.jump(self.now_ns())
        self._is_paused = False

    def set_rate(self, rate: float) -> bool:
        """Go faster or slower; whether it is a rate: above 0, and not more than can be counted."""
        if not 0 < rate <= _RATE_MAX:
            return False
        self.jump(self.now_ns())
        self._rate = rate
        return True
