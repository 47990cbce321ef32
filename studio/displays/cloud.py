"""Points of one message: their positions, their other fields, and which of too many are shown."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from studio.displays.display import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from studio.displays.drawing import Sweep

# Multiples of the golden ratio, taken modulo 1, fill the circle evenly however many there are, and
# those below a threshold lie evenly among the numbers. A lower threshold keeps a part of the same.
_GOLDEN: Final = np.uint32(2_654_435_769)
_CIRCLE: Final = 1 << 32
# More than are asked for come of the threshold, so that cutting meets the number exactly.
_SLACK: Final = 16


@lru_cache(maxsize=8)
def evenly(count: int, limit: int) -> NDArray[np.intp]:
    """Choose `limit` of the numbers below `count`, ascending; all when there are no more."""
    if count <= limit:
        chosen = np.arange(count)
    else:
        chosen = np.flatnonzero(_keys(count) < _threshold(count, limit))[:limit]
    chosen.setflags(write=False)
    return chosen


def evenly_among(kept: NDArray[np.bool_], limit: int) -> NDArray[np.intp]:
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


class Channels(Protocol):
    """The other fields of the points of a message, by the index of the point in the message."""

    names: tuple[str, ...]

    @property
    def size_bytes(self) -> int:
        """Memory that the message takes."""
        ...

    def numbers(self, name: str, raw: NDArray[np.intp] | None) -> NDArray[np.float32] | None:
        """Return one number for each, or None when there is no such channel."""
        ...

    def colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours of bytes, shape (N, 3), or None."""
        ...

    def float_colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours of fractions, shape (N, 3), or None."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Cloud:
    """The points of one message that are drawn.

    Attributes:
        frame: The message's.
        stamp_ns: The message's.
        positions: Shape (N, 3), float32, m.
        raw: Index of each in the message; None when all are drawn.
        available: Number of points with finite coordinates.
        channels: The message's.
        nothing: Why there are no points.
        sweep: When each was measured, if not all at the stamp.
    """

    frame: str
    stamp_ns: int
    positions: NDArray[np.float32]
    raw: NDArray[np.intp] | None
    available: int
    channels: Channels
    nothing: Status | None = None
    sweep: Sweep | None = None

    @property
    def count(self) -> int:
        """Number of points drawn."""
        return len(self.positions)

    def numbers(self, name: str) -> NDArray[np.float32] | None:
        """Return the numbers of a channel, shape (N,)."""
        return self.channels.numbers(name, self.raw)


def kept(
    positions: NDArray[np.float32], limit: int
) -> tuple[NDArray[np.float32], NDArray[np.intp] | None, int]:
    """Leave out what is NaN or infinite, and what is more than the limit.

    Returns:
        The positions that stay, which they are (None when all), and how many have a place.
    """
    if not len(positions):
        return positions, None, 0
    chosen: NDArray[np.intp] | None = None
    available = len(positions)
    # The least and the greatest number carry every NaN and every infinity with them.
    with np.errstate(over="ignore", invalid="ignore"):
        whole = np.isfinite(positions.min() - positions.max())
        # Column by column: a product of matrices starts threads, which wait on a busy machine.
        finite = whole or np.isfinite(positions[:, 0] + positions[:, 1] + positions[:, 2])
    if not whole:
        available = int(np.count_nonzero(finite))
        chosen = evenly_among(finite, limit)
    elif available > limit:
        chosen = evenly(available, limit)
    return (positions if chosen is None else positions.take(chosen, axis=0)), chosen, available


def nothing_of(count: int, shown: NDArray[np.float32]) -> Status | None:
    """Return a status if none of so many points is shown."""
    if len(shown):
        return None
    if not count:
        return Status("warn", "no_points", "The cloud has no points.")
    sentence = f"None of the {count:,} points has a place: all are NaN or infinite."
    return Status("warn", "not_finite", sentence)


def rgb_of_shares(parts: Sequence[NDArray[np.float32]]) -> NDArray[np.uint8]:
    """Return colours, shape (N, 3), of red, green and blue (N,) from 0 to 1; NaN is 0."""
    return np.rint(np.nan_to_num(np.clip(np.stack(parts, axis=1), 0, 1)) * 255).astype(np.uint8)


def listed(names: tuple[str, ...]) -> str:
    """Return names within a sentence, cut where there are many."""
    shown = ", ".join(name[:40] for name in names[:12])
    return f"{shown} and {len(names) - 12} more" if len(names) > 12 else shown or "none"
