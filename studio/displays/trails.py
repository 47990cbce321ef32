"""Trails: the ways that frames took of late, as lines in the fixed frame."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Final

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


class Trails:
    """Where some frames were; each keeps what is no longer or older than is given."""

    def __init__(self, *, length_m: float = math.inf, width_m: float = 0.01) -> None:
        self._length_m, self._width_m = length_m, width_m
        self._points: dict[str, deque[tuple[int, float, float, float]]] = {}
        """By frame: when it was where, ns since the epoch and m."""
        self._fixed = ""
        self._lines: Lines | None = None
        self._changed = True

    def keep(self, frames: Collection[str], fixed: str) -> None:
        """Forget all other frames, and all if they are seen from another one now."""
        if fixed != self._fixed:
            self._fixed, self._points, self._changed = fixed, {}, True
        for gone in self._points.keys() - frozenset(frames):
            del self._points[gone]
            self._changed = True

    def add(self, frame: str, xyz: Iterable[float], now_ns: int) -> None:
        """Take where a frame is; it goes on its trail if it moved."""
        x, y, z = xyz
        points = self._points.get(frame)
        if points is None:
            if len(self._points) >= TRAILS_MAX:
                return
            points = self._points[frame] = deque(maxlen=POINTS_MAX)
        if not points or math.dist(points[-1][1:], (x, y, z)) >= _STEP_M:
            points.append((now_ns, x, y, z))
            self._changed = True
            self._shorten(points)

    def forget_before(self, ns: int) -> None:
        """Drop what is older, but for the place that a frame still has."""
        for points in self._points.values():
            while len(points) > 1 and points[0][0] < ns:
                points.popleft()
                self._changed = True

    def lines(self, rgb: Rgb) -> Lines | None:
        """Return all trails, the same object as long as nothing moved; None: there is none."""
        if self._changed:
            self._changed = False
            ends = [_ends(points) for points in self._points.values() if len(points) > 1]
            colour = np.array(rgb, np.uint8)
            made = Lines(np.concatenate(ends), colour, self._width_m) if ends else None
            self._lines = made
        return self._lines

    def _shorten(self, points: deque[tuple[int, float, float, float]]) -> None:
        if self._length_m == math.inf:
            return
        rows = np.array(points)[:, 1:]
        steps = np.linalg.norm(np.diff(rows, axis=0), axis=1)[::-1]
        kept = 1 + int(np.count_nonzero(np.cumsum(steps) <= self._length_m))
        while len(points) > max(kept, 2):
            points.popleft()


def _ends(points: deque[tuple[int, float, float, float]]) -> NDArray[np.float32]:
    rows = np.array(points)[:, 1:].astype(np.float32)
    return np.stack((rows[:-1], rows[1:]), axis=1)
