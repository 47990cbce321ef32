"""Cloud: points that have a place, and what else their message says of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from studio.displays.spreading import spread, spread_among

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Status
    from studio.displays.drawing import Sweep


class Channels(Protocol):
    """What a message says of its points, by raw point."""

    names: tuple[str, ...]

    @property
    def size_bytes(self) -> int:
        """Of what is kept of the message."""
        ...

    def numbers(self, name: str, raw: NDArray[np.intp] | None) -> NDArray[np.float32] | None:
        """One number for each, or None when there is no such channel."""
        ...

    def colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours of bytes, shape (N, 3), or None."""
        ...

    def float_colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Colours of fractions, shape (N, 3), or None."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Cloud:
    """What is shown of one message.

    Attributes:
        frame: Of the message.
        stamp_ns: Of the message.
        positions: Shape (N, 3), float32, m: those that are shown.
        raw: Which points of the message they are; None when all are shown.
        available: How many have a place.
        channels: Of the message.
        nothing: Why there are no points.
        sweep: When each was met, if that was not all at the stamp.
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
        """Of points that are shown."""
        return len(self.positions)

    def numbers(self, name: str) -> NDArray[np.float32] | None:
        """The numbers of a channel, shape (N,)."""
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
        chosen = spread_among(finite, limit)
    elif available > limit:
        chosen = spread(available, limit)
    return (positions if chosen is None else positions.take(chosen, axis=0)), chosen, available


def stamp_of(header: object) -> int:
    """The stamp of a header in ns since the epoch."""
    stamp = getattr(header, "stamp")  # noqa: B009 - a std_msgs/Header of any distribution
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)
