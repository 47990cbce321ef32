"""Colour maps: from a share between 0 and 1 to a colour, by tables that are made once."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

RAINBOW: Final = "Rainbow"
COLOUR_MAPS: Final = (RAINBOW, "Turbo", "Viridis")

_STEPS: Final = 4096
# Nine equal parts between ten colours each: the difference from the curve is invisible.
_STOPS: Final = {
    "Turbo": "30123b 4662d7 36aaf9 1ae4b6 72fe5e c7ef34 faba39 f66b19 cb2a04 7a0403",
    "Viridis": "440154 482878 3e4a89 31688e 26828e 1f9e89 35b779 6dcd59 b4de2c fde725",
}


def mapped(shares: NDArray[np.floating], name: str, *, inverted: bool = False) -> NDArray[np.uint8]:
    """Return the colours of shares.

    Args:
        shares: Shape (N,); what is below 0 or above 1 is as those, NaN as 0.
        name: One of `COLOUR_MAPS`.
        inverted: Whether 0 is the last colour.

    Returns:
        Shape (N, 3).
    """
    steps = np.clip(shares, 0, 1) * (_STEPS - 1)
    np.nan_to_num(steps, copy=False)
    return table(name, inverted=inverted).take(steps.astype(np.intp), axis=0, mode="clip")


@cache
def table(name: str, *, inverted: bool = False) -> NDArray[np.uint8]:
    """Return all colours of a map in order, shape (4096, 3), read-only."""
    shares = np.linspace(0, 1, _STEPS)
    parts = _rainbow(shares) if name == RAINBOW else _between(_STOPS[name], shares)
    colours = np.rint(np.clip(parts, 0, 1) * 255).astype(np.uint8)
    made = np.ascontiguousarray(colours[::-1] if inverted else colours)
    made.setflags(write=False)
    return made


def _rainbow(shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """RViz's: hues from red to magenta."""
    sixths = 5 * shares
    parts = (np.abs(sixths - 3) - 1, 2 - np.abs(sixths - 2), 2 - np.abs(sixths - 4))
    return np.stack(parts, axis=1)


def _between(stops: str, shares: NDArray[np.float64]) -> NDArray[np.float64]:
    colours = np.array([tuple(bytes.fromhex(stop)) for stop in stops.split()]) / 255
    at = np.linspace(0, 1, len(colours))
    return np.stack([np.interp(shares, at, colours[:, part]) for part in range(3)], axis=1)
