"""Spreading: which points are shown when there are too many, evenly and the same ones each time."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Multiples of the golden ratio, taken modulo 1, fill the circle evenly however many there are, and
# those below a threshold lie evenly among the numbers. A lower threshold keeps a part of the same.
_GOLDEN: Final = np.uint32(2_654_435_769)
_CIRCLE: Final = 1 << 32
# More than are asked for come of the threshold, so that cutting meets the number exactly.
_SLACK: Final = 16


@lru_cache(maxsize=8)
def spread(count: int, limit: int) -> NDArray[np.intp]:
    """Choose `limit` of the numbers below `count`, ascending; all when there are no more."""
    if count <= limit:
        chosen = np.arange(count)
    else:
        chosen = np.flatnonzero(_keys(count) < _threshold(count, limit))[:limit]
    chosen.setflags(write=False)
    return chosen


def spread_among(kept: NDArray[np.bool_], limit: int) -> NDArray[np.intp]:
    """Choose at most `limit` of the places that are kept, ascending; all when there are no more."""
    count = int(np.count_nonzero(kept))
    if count <= limit:
        return np.flatnonzero(kept)
    return np.flatnonzero(kept & (_keys(kept.size) < _threshold(count, limit)))[:limit]


def _threshold(count: int, limit: int) -> np.uint32:
    return np.uint32(min((limit + _SLACK) * _CIRCLE // count, _CIRCLE - 1))


@lru_cache(maxsize=4)
def _keys(count: int) -> NDArray[np.uint32]:
    return np.arange(count, dtype=np.uint32) * _GOLDEN
