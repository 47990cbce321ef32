"""Following: joint positions on their way from the wire's thread to the engine's loop."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Final, Literal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

SILENT_AFTER_S: Final = 2.0
_STRANGERS_KEPT: Final = 12
_RATE_OVER_S: Final = 1.0
_ARRIVALS_KEPT: Final = 2000
"""More in a second than this are told as this."""


class Following:
    """The newest position of each joint, so that a slow loop skips and does not lag.

    `take`: any thread; all else: the loop. Several who publish some of the joints each go together.
    """

    def __init__(self, clock: Callable[[], float], movable: Iterable[str]) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._movable = frozenset(movable)
        self._newest: dict[str, float] = {}
        self._strangers: dict[str, None] = {}
        self._arrivals: deque[float] = deque(maxlen=_ARRIVALS_KEPT)
        self._last_s: float | None = None
        self._newest_stamp_ns = 0
        self.stamp_ns = 0
        """When the source measured what was collected last, by its own clock; 0: it did not say."""

    def fit(self, movable: Iterable[str]) -> None:
        """The robot has other joints now."""
        with self._lock:
            self._movable = frozenset(movable)
            self._strangers.clear()

    def take(self, positions: Mapping[str, float], stamp_ns: int = 0) -> None:
        """A message came; rad or m by name of the joint, and its stamp."""
        now_s = self._clock()
        with self._lock:
            self._last_s, self._newest_stamp_ns = now_s, stamp_ns
            self._arrivals.append(now_s)
            for name, position in positions.items():
                if name in self._movable:
                    self._newest[name] = position
                elif len(self._strangers) < _STRANGERS_KEPT:
                    self._strangers[name] = None

    def collect(self) -> dict[str, float]:
        """What came since the last time."""
        with self._lock:
            taken, self._newest = self._newest, {}
            self.stamp_ns = self._newest_stamp_ns
        return taken

    def strangers(self) -> tuple[str, ...]:
        """Joints that came and that the robot does not have; the first ones."""
        with self._lock:
            return tuple(self._strangers)

    def state(self) -> Literal["waiting", "live", "silent"]:
        """Whether anything came yet, and lately."""
        last_s = self._last_s
        if last_s is None:
            return "waiting"
        return "live" if self._clock() - last_s < SILENT_AFTER_S else "silent"

    def rate_hz(self) -> int:
        """Messages of the last second."""
        since_s = self._clock() - _RATE_OVER_S
        with self._lock:
            return sum(1 for at_s in self._arrivals if at_s > since_s)
