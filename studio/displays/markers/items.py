"""Points of many markers in their frame, their colours, and parts of one opacity and size."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.turning import turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Floats, Whole
    from studio.displays.markers.table import Rows

_LEVELS_MAX: Final = 16
_LEVEL_STEP: Final = 255 // (_LEVELS_MAX - 1)
_SIZES_MAX: Final = 32
# Steps of 12 %, which hardly anybody sees.
_SIZES_PER_DECADE: Final = 20


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
    """Return points (P, 3) in the frame of their markers, `owners` (P,)."""
    is_turned = np.abs(markers.rotations_wxyz[:, 0]) < 1.0
    moving = is_turned[owners]
    placed = points + markers.positions[owners]
    if moving.any():
        whose = owners[moving]
        round_origin = turned(markers.rotations_wxyz[whose], points[moving])
        placed[moving] = round_origin + markers.positions[whose]
    return placed


def item_colors(markers: Rows, items: PlacedItems) -> NDArray[np.float32]:
    """Return each point's own colour if its marker has one for each, else the marker's. (P, 4)."""
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


def rgb_of(rgba: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Colours (N, 4) of 0 to 1 as (N, 3) of 0 to 255; (3,) when all are the same."""
    colors = colors_of(rgba)
    if len(colors) and (colors == colors[0]).all():
        return colors[0].copy()
    return colors


def colors_of(rgba: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Colours (N, 4) of 0 to 1 as (N, 3) of 0 to 255."""
    return np.rint(255 * np.clip(rgba[:, :3], 0.0, 1.0)).astype(np.uint8)


def alphas_of(rgba: NDArray[np.float32]) -> NDArray[np.intp]:
    """Opacities (N,) from 0 to 255."""
    return np.rint(255 * np.clip(rgba[:, 3], 0.0, 1.0)).astype(np.intp)


class Part(NamedTuple):
    """Things that can be drawn as one."""

    chosen: Whole
    """Shape (P,): which."""
    opacity: float
    size_m: float


def parts_of(alphas: NDArray[np.intp], sizes_m: Floats) -> list[Part]:
    """Sort things by opacity and size; what is clear or of no size is in no part.

    At most so many opacities and sizes are distinguished: of more, similar ones are one.

    Args:
        alphas: Shape (N,), 0 to 255.
        sizes_m: Shape (N,).
    """
    seen = np.flatnonzero((alphas > 0) & (sizes_m > 0))
    levels, sizes = _few_levels(alphas[seen]), _few_sizes(sizes_m[seen])
    parts: list[Part] = []
    for size in np.unique(sizes).tolist():
        of_size = sizes == size
        parts += [
            Part(seen[of_size & (levels == level)], level / 255, size)
            for level in np.unique(levels[of_size]).tolist()
        ]
    return parts


def _few_levels(alphas: NDArray[np.intp]) -> NDArray[np.intp]:
    if len(np.unique(alphas)) <= _LEVELS_MAX:
        return alphas
    return -(-alphas // _LEVEL_STEP) * _LEVEL_STEP


def _few_sizes(sizes_m: Floats) -> Floats:
    if len(np.unique(sizes_m)) <= _SIZES_MAX:
        return sizes_m
    return 10 ** (np.rint(_SIZES_PER_DECADE * np.log10(sizes_m)) / _SIZES_PER_DECADE)
