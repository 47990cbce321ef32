"""Placed points of markers: those of many, one after another, where they are in the frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from studio.displays.turning import turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Floats, Whole
    from studio.displays.markers.table import Rows


class PlacedItems(NamedTuple):
    """All P points of M markers."""

    positions: Floats
    """Shape (P, 3), m in the frame."""
    owners: Whole
    """Shape (P,): which of the markers each belongs to."""
    starts: Whole
    """Shape (M + 1,): where those of each marker begin."""


def placed_items(markers: Rows, *, scaled: bool = False) -> PlacedItems:
    """Put the points of markers where they are; scales count for surfaces alone."""
    counts = [len(each.points) for each in markers.items]
    owners = np.repeat(np.arange(len(counts)), counts)
    points = np.concatenate([each.points for each in markers.items])
    if scaled:
        points = points * markers.scales[owners]
    return PlacedItems(
        place(markers, owners, points),
        owners,
        np.concatenate(([0], np.cumsum(counts, dtype=np.intp))),
    )


def place(markers: Rows, owners: Whole, points: Floats) -> Floats:
    """Points (P, 3) of markers in their frame; `owners` (P,) tells whose each is."""
    is_turned = np.abs(markers.rotations_wxyz[:, 0]) < 1.0
    moving = is_turned[owners]
    placed = points + markers.positions[owners]
    if moving.any():
        whose = owners[moving]
        round_origin = turned(markers.rotations_wxyz[whose], points[moving])
        placed[moving] = round_origin + markers.positions[whose]
    return placed


def item_colors(markers: Rows, items: PlacedItems) -> NDArray[np.float32]:
    """Of each point its own colour if the marker has one for each, else the marker's. (P, 4)."""
    if not any(len(each.rgba) for each in markers.items):
        return markers.rgba[items.owners]
    return np.concatenate(
        [
            each.rgba
            if len(each.rgba)
            else np.broadcast_to(markers.rgba[at], (len(each.points), 4))
            for at, each in enumerate(markers.items)
        ]
    )
