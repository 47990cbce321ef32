"""Palettes of maps: the colour of every value that a cell can have, as RViz has them."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

SCHEMES: Final = ("map", "costmap", "raw")
_UNKNOWN: Final = (0x70, 0x89, 0x86)


@cache
def palette(scheme: str, threshold: int | None = None) -> NDArray[np.uint8]:
    """Colours by the value of a cell, taken as an unsigned byte.

    Args:
        scheme: One of `SCHEMES`.
        threshold: From which value on a cell is occupied, when there are only two colours.

    Returns:
        Shape (256, 4), RGBA, read-only.
    """
    colours = np.zeros((256, 4), dtype=np.uint8)
    colours[:, 3] = 255
    {"map": _map, "costmap": _costmap, "raw": _raw}[scheme](colours, threshold)
    if scheme != "raw":
        _illegal(colours)
    colours.setflags(write=False)
    return colours


def _map(colours: NDArray[np.uint8], threshold: int | None) -> None:
    if threshold is not None:
        colours[:threshold, :3] = 255
        colours[threshold:101, :3] = 0
        return
    colours[:101, :3] = (255 - 255 * np.arange(101) // 100)[:, None]


def _costmap(colours: NDArray[np.uint8], threshold: int | None) -> None:
    if threshold is not None:
        colours[:threshold, :3] = (0, 0, 255)
        colours[threshold:101, :3] = (255, 0, 0)
        return
    colours[0] = 0
    costs = 255 * np.arange(1, 99) // 100
    colours[1:99, 0], colours[1:99, 2] = costs, 255 - costs
    colours[99, :3] = (0, 255, 255)
    colours[100, :3] = (255, 0, 255)


def _raw(colours: NDArray[np.uint8], threshold: int | None) -> None:
    if threshold is not None:
        colours[threshold:, :3] = 255
        return
    colours[:, :3] = np.arange(256)[:, None]


def _illegal(colours: NDArray[np.uint8]) -> None:
    """Values that no map has: green above 100, red to yellow below -1; and -1, which is unknown."""
    colours[101:128, :3] = (0, 255, 0)
    below = np.arange(127)
    colours[128:255, 0], colours[128:255, 1], colours[128:255, 2] = 255, 255 * below // 126, 0
    colours[255, :3] = _UNKNOWN
