"""Trails: the ways that frames took of late, as lines in the fixed frame."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.drawing import Lines

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from numpy.typing import NDArray

    from studio.displays.drawing import Rgb

POINTS_MAX: Final = 300
"""Of each trail."""
TRAILS_MAX: Final = 200
_STEP_M: Final = 0.005
"""A frame that moved less is where it was."""


class _Trail(NamedTuple):
    """Where a frame was, shape (N, 3), m, and when, shape (N,), ns since the epoch."""

    places: NDArray[np.float64]
    times_ns: NDArray[np.int64]

    def since(self, row: int) -> _Trail:
        """Return it from a row on."""
        return _Trail(self.places[row:], self.times_ns[row:])


class Trails:
    """Where some frames were; each keeps what is no longer or older than is given."""

    def __init__(self, *, length_m: float = math.inf, width_m: float = 0.01) -> None:
        self._length_m, self._width_m = length_m, width_m
        self._trails: dict[str, _Trail] = {}
        """By frame."""
        self._fixed = ""
        self._lines: Lines | None = None
        self._changed = True

    def keep(self, frames: Collection[str], fixed: str) -> None:
        """Forget all other frames, and all if they are seen from another one now."""
        if fixed != self._fixed:
            self._fixed, self._trails, self._changed = fixed, {}, True
        for gone in self._trails.keys() - frozenset(frames):
            del self._trails[gone]
            self._changed = True

    def add(self, frame: str, xyz: Iterable[float], now_ns: int) -> None:
        """Take where a frame is; it goes on its trail if it moved."""
        place, time_ns = np.array([[*xyz]], np.float64), np.array([now_ns], np.int64)
        trail = self._trails.get(frame)
        if trail is None:
            if len(self._trails) < TRAILS_MAX:
                self._trails[frame] = _Trail(place, time_ns)
                self._changed = True
        elif math.dist(trail.places[-1], place[0]) >= _STEP_M:
            before = trail.since(max(0, len(trail.places) + 1 - POINTS_MAX))
            longer = _Trail(
                np.concatenate((before.places, place)), np.concatenate((before.times_ns, time_ns))
            )
            self._trails[frame] = self._shortened(longer)
            self._changed = True

    def forget_before(self, ns: int) -> None:
        """Drop what is older, but for the place that a frame still has."""
        for frame, trail in self._trails.items():
            if trail.times_ns[0] < ns and len(trail.places) > 1:
                old = int(np.searchsorted(trail.times_ns, ns))
                self._trails[frame] = trail.since(min(old, len(trail.places) - 1))
                self._changed = True

    def lines(self, rgb: Rgb) -> Lines | None:
        """Return all trails, the same object as long as nothing moved; None: there is none."""
        if self._changed:
            self._changed = False
            ends = _ends([one.places for one in self._trails.values()])
            colour = np.array(rgb, np.uint8)
            self._lines = Lines(ends, colour, self._width_m) if len(ends) else None
        return self._lines

    def _shortened(self, trail: _Trail) -> _Trail:
        if self._length_m == math.inf:
            return trail
        steps_m = np.linalg.norm(np.diff(trail.places, axis=0), axis=1)[::-1]
        kept = 1 + int(np.count_nonzero(np.cumsum(steps_m) <= self._length_m))
        return trail.since(max(0, len(trail.places) - max(kept, 2)))


def _ends(trails: list[NDArray[np.float64]]) -> NDArray[np.float32]:
    """Return the pieces of trails (N, 3), one after the other, shape (P, 2, 3)."""
    ends = np.empty((sum(len(one) - 1 for one in trails), 2, 3), np.float32)
    begin = 0
    for places in trails:
        pieces = ends[begin : begin + len(places) - 1]
        pieces[:, 0], pieces[:, 1] = places[:-1], places[1:]
        begin += len(pieces)
    return ends
