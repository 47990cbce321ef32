"""GridCellsDisplay: cells of a grid as tiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.display import TopicRole
from studio.displays.drawing import Triangles
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import NOT_FINITE, chosen_rows
from studio.displays.properties import RVIZ_GREEN, colour_of, colour_properties, rgb_of
from studio.displays.turning import FAR, drawable
from studio.ros.columns.poses import GRID_CELLS, read_grid_cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.turning import Floats

CELLS_MAX: Final = 100_000
# Of a tile of 1 by 1 m about its middle, and the two triangles that it is made of.
_CORNERS = np.array([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]])
_HALVES = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)


class Cells(NamedTuple):
    """Middles (N, 3) of tiles, m, and what each measures along x, y and z: 0."""

    middles: Floats
    size_m: Floats


class GridCellsDisplay(HistoryDisplay[Cells]):
    """Draws the cells of the newest message."""

    KIND = "GridCells"
    DOC = "Cells of a grid, as the obstacles of a costmap are."
    ICON = "grid"
    TOPICS = (TopicRole("", (GRID_CELLS,)),)
    PROPERTIES = colour_properties(RVIZ_GREEN, "cells")

    def read(self, received: Received) -> Entry[Cells] | None:
        """Return the cells that can be drawn."""
        read = read_grid_cells(received.cdr)
        size_m = np.array([abs(read.width_m), abs(read.height_m), 0.0])
        if not (size_m <= FAR).all():
            return self.refuse("not_finite", NOT_FINITE)
        if not size_m[:2].all():
            return self.refuse(
                "empty", "A side of the cells is 0 m long, so that they cannot be seen."
            )
        rows, at_most = read.cells.rows, min(CELLS_MAX, self.limits.points)
        middles = chosen_rows(rows, drawable(rows), "cells", at_most, self)
        if middles is None:
            return None
        return Entry(read.cells.frame, read.cells.stamp_ns, Cells(middles, size_m))

    def shapes(self, content: Cells) -> dict[str, Shape]:
        """Return one surface of all tiles."""
        count = len(content.middles)
        if not count:
            return {}
        corners = content.middles[:, None] + _CORNERS * content.size_m
        colour = colour_of(rgb_of(self.values["Color"]))
        vertices = corners.reshape(-1, 3).astype(np.float32)
        return {"cells": Triangles(vertices, _faces(count), colour, self.number("Alpha"))}


def _faces(count: int) -> NDArray[np.uint32]:
    first = np.arange(count, dtype=np.uint32) * 4
    return (first[:, None, None] + _HALVES).reshape(-1, 3)
