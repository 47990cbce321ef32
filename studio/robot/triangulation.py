"""Polygons, fans and strips to triangles, all at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Integers: TypeAlias = NDArray[np.int64]


def fan_corners(sizes: Integers) -> Integers:
    """Corners of the triangles that fan out from the first corner of each polygon."""
    first, second = _within(sizes)
    return np.stack((first, first + second, first + second + 1), axis=1).ravel()


def strip_corners(sizes: Integers) -> Integers:
    """Corners of the triangles of strips; every second one turns the other way round."""
    first, second = _within(sizes)
    at = first + second - 1
    odd = second % 2 == 0
    return np.stack((at, at + 1 + odd, at + 2 - odd), axis=1).ravel()


def _within(sizes: Integers) -> tuple[Integers, Integers]:
    """For each triangle the first corner of its polygon, and its number there, from 1."""
    triangles = np.maximum(sizes - 2, 0)
    starts = np.cumsum(sizes) - sizes
    before = np.cumsum(triangles) - triangles
    number = np.arange(int(triangles.sum())) - np.repeat(before, triangles) + 1
    return np.repeat(starts, triangles), number
