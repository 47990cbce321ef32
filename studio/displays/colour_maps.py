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
# Coefficients of t^0 to t^5 for red, green and blue: turbo's own published approximation.
_TURBO: Final = np.array([
    (0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943),
    (0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604),
    (0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973),
])  # fmt: skip
_VIRIDIS: Final = (
    "440154", "482878", "3e4989", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b",
    "fde725",
)  # fmt: skip


def mapped(shares: NDArray[np.floating], name: str, *, inverted: bool = False) -> NDArray[np.uint8]:
    """The colours of shares.

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
    """All colours of a map in their order, shape (4096, 3), read-only."""
    shares = np.linspace(0, 1, _STEPS)
    maker = {RAINBOW: _rainbow, "Turbo": _turbo, "Viridis": _viridis}[name]
    colours = np.rint(np.clip(maker(shares), 0, 1) * 255).astype(np.uint8)
    made = np.ascontiguousarray(colours[::-1] if inverted else colours)
    made.setflags(write=False)
    return made


def _rainbow(shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """RViz's: hues from red to magenta."""
    sixths = 5 * shares
    parts = (np.abs(sixths - 3) - 1, 2 - np.abs(sixths - 2), 2 - np.abs(sixths - 4))
    return np.stack(parts, axis=1)


def _turbo(shares: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.power(shares[:, None], np.arange(6)) @ _TURBO.T


def _viridis(shares: NDArray[np.float64]) -> NDArray[np.float64]:
    stops = np.array([tuple(bytes.fromhex(stop)) for stop in _VIRIDIS]) / 255
    at = np.linspace(0, 1, len(stops))
    return np.stack([np.interp(shares, at, stops[:, part]) for part in range(3)], axis=1)
