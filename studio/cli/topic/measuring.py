"""How often samples come, how large and how late they are, over a window of the newest."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

WINDOW = 10_000
_KILO, _MEGA = 1e3, 1e6


@dataclass(frozen=True, slots=True)
class Spread:
    """Of some numbers: how many, mean, extremes and the deviation from the mean."""

    count: int
    mean: float
    lowest: float
    highest: float
    deviation: float

    @classmethod
    def of(cls, numbers: Iterable[float]) -> Spread:
        """Take the measure of at least one number."""
        all_of_them = list(numbers)
        mean = math.fsum(all_of_them) / len(all_of_them)
        squares = math.fsum((one - mean) ** 2 for one in all_of_them)
        return cls(
            len(all_of_them),
            mean,
            min(all_of_them),
            max(all_of_them),
            math.sqrt(squares / len(all_of_them)),
        )


class Rate:
    """The time between samples; times in seconds of any clock that does not jump."""

    def __init__(self, window: int = WINDOW) -> None:
        self._gaps_s: deque[float] = deque(maxlen=window)
        self._last_s: float | None = None

    def add(self, time_s: float) -> None:
        """A sample came; a clock that went backwards begins anew."""
        if self._last_s is not None and time_s < self._last_s:
            self._gaps_s.clear()
        elif self._last_s is not None:
            self._gaps_s.append(time_s - self._last_s)
        self._last_s = time_s

    @property
    def hertz(self) -> float | None:
        """The mean rate; None before the second sample, or when all came at once."""
        total_s = math.fsum(self._gaps_s)
        return len(self._gaps_s) / total_s if total_s > 0 else None

    def gaps(self) -> Spread:
        """Take the measure of the times between samples, seconds; there must be some."""
        return Spread.of(self._gaps_s)

    def report(self) -> str | None:
        """Say it as `ros2 topic hz` does; None when there is nothing to say."""
        if self.hertz is None:
            return None
        gaps = self.gaps()
        return f"average rate: {self.hertz:.3f}\n{_spread_text(gaps, gaps.count + 1)}"


class Delay:
    """How old samples are when they come, by the stamp of their header."""

    def __init__(self, window: int = WINDOW) -> None:
        self._delays_s: deque[float] = deque(maxlen=window)

    def add(self, delay_s: float) -> None:
        """A sample of this age came."""
        self._delays_s.append(delay_s)

    def report(self) -> str | None:
        """Say it as `ros2 topic delay` does; None when there is nothing to say."""
        if not self._delays_s:
            return None
        delays = Spread.of(self._delays_s)
        return f"average delay: {delays.mean:.3f}\n{_spread_text(delays, delays.count)}"


class Bandwidth:
    """Bytes per second, from the oldest sample of the window until now."""

    def __init__(self, window: int = 100) -> None:
        self._samples: deque[tuple[float, int]] = deque(maxlen=window)

    def add(self, time_s: float, size_bytes: int) -> None:
        """A sample of this size came."""
        self._samples.append((time_s, size_bytes))

    def report(self, now_s: float) -> str | None:
        """Say it as `ros2 topic bw` does; None before the second sample."""
        if len(self._samples) < 2 or now_s <= self._samples[0][0]:
            return None
        sizes = Spread.of(size for _, size in self._samples)
        bytes_per_s = sizes.mean * sizes.count / (now_s - self._samples[0][0])
        unit, name = _unit(bytes_per_s)
        places = 0 if unit == 1 else 2
        rate, mean, lowest, highest = (
            f"{number / unit:.{places}f} {name}"
            for number in (bytes_per_s, sizes.mean, sizes.lowest, sizes.highest)
        )
        return (
            f"{rate}/s from {sizes.count} messages\n"
            f"\tMessage size mean: {mean} min: {lowest} max: {highest}"
        )


def _unit(bytes_per_s: float) -> tuple[float, str]:
    if bytes_per_s < _KILO:
        return 1, "B"
    return (_KILO, "KB") if bytes_per_s < _MEGA else (_MEGA, "MB")


def _spread_text(spread: Spread, window: int) -> str:
    return (
        f"\tmin: {spread.lowest:.3f}s max: {spread.highest:.3f}s "
        f"std dev: {spread.deviation:.5f}s window: {window}"
    )
