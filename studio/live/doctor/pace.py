"""Pace: how often something usually comes, and whether it comes more seldom now, or no more."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Final

_KEPT_S: Final = 180
_BURST_MIN: Final = 5
"""So many must have come before anything is called usual."""
_SILENT_PERIODS: Final = 5
_SILENT_GAPS: Final = 2
_SILENT_AT_LEAST_S: Final = 2.0
_RECENT_S: Final = 3.0
_RECENT_COUNT: Final = 6
"""The time that is called recent is so long that so many would come in it."""
_SLOW_SHARE: Final = 0.6


@dataclass(frozen=True, slots=True)
class PaceNow:
    """How something comes now, beside what is usual for it.

    Attributes:
        usual_hz: Rate until a moment ago; 0 while too little came to say.
        recent_hz: Rate of the last seconds.
        silent_s: Time since the last one; None: none came.
        is_silent: Nothing comes for much longer than ever between two.
        is_slow: It comes clearly more seldom than usual, and comes still.
    """

    usual_hz: float = 0.0
    recent_hz: float = 0.0
    silent_s: float | None = None
    is_silent: bool = False
    is_slow: bool = False


class Pace:
    """Counts arrivals by the second; times are of one clock, in seconds. Not thread-safe."""

    def __init__(self) -> None:
        self._counts: deque[tuple[int, int]] = deque()
        """Whole seconds in which something came, and how many."""
        self._total = 0
        self._first_s = self._last_s = 0.0
        self._longest_gap_s = 0.0

    def count(self, now_s: float, arrivals: int) -> None:
        """Count what came just now."""
        if self._total:
            self._longest_gap_s = max(self._longest_gap_s, now_s - self._last_s)
        else:
            self._first_s = now_s
        self._total, self._last_s = self._total + arrivals, now_s
        second = int(now_s)
        if self._counts and self._counts[-1][0] == second:
            arrivals += self._counts.pop()[1]
        self._counts.append((second, arrivals))
        while self._counts[0][0] < second - _KEPT_S:
            self._counts.popleft()
            self._first_s = max(self._first_s, float(self._counts[0][0]))

    def now(self, now_s: float) -> PaceNow:
        """Return how it comes at a time."""
        if not self._total:
            return PaceNow()
        silent_s = max(0.0, now_s - self._last_s)
        span_s = self._last_s - self._first_s
        counted = sum(count for _, count in self._counts)
        if counted < _BURST_MIN or span_s <= 0:
            return PaceNow(silent_s=silent_s)
        mean_hz = (counted - 1) / span_s
        patience_s = max(
            _SILENT_AT_LEAST_S, _SILENT_PERIODS / mean_hz, _SILENT_GAPS * self._longest_gap_s
        )
        if silent_s > patience_s:
            return PaceNow(mean_hz, 0.0, silent_s, is_silent=True)
        return self._compared(now_s, mean_hz, silent_s)

    def _compared(self, now_s: float, mean_hz: float, silent_s: float) -> PaceNow:
        """Compare the last seconds with those before."""
        recent_s = max(_RECENT_S, _RECENT_COUNT / mean_hz)
        # By whole seconds: one that is not over yet would look slow.
        end, begin = int(now_s), int(now_s - recent_s)
        before_s = begin - self._first_s
        if before_s < 2 * recent_s or end <= begin:
            return PaceNow(mean_hz, mean_hz, silent_s)
        before = sum(count for second, count in self._counts if second < begin)
        recent = sum(count for second, count in self._counts if begin <= second < end)
        usual_hz, recent_hz = before / before_s, recent / (end - begin)
        is_slow = recent_hz < _SLOW_SHARE * usual_hz
        return PaceNow(usual_hz, recent_hz, silent_s, is_slow=is_slow)
