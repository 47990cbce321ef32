"""GridCellsDisplay: cells of a grid as tiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.display import TopicRole
from studio.displays.drawing import Triangles
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import NOT_FINITE, chosen_rows, numbered
from studio.displays.properties import RVIZ_GREEN, colour_of, colour_properties, rgb_of
from studio.displays.selection import Fact, Item, box_at, number_fact, position_fact, row_of
from studio.displays.turning import FAR, drawable
from studio.ros.columns.poses import GRID_CELLS, read_grid_cells

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.selection import Picked
    from studio.displays.turning import Floats
    from studio.ros.types.classes import MessageValue

CELLS_MAX: Final = 100_000
# Of a tile of 1 by 1 m about its middle, and the two triangles that it is made of.
_CORNERS = np.array([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]])
_HALVES = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)


class Cells(NamedTuple):
    """Middles (N, 3) of tiles, m, and what each measures along x, y and z: 0.

    `numbers`, shape (N,) and ascending, are their indices in the message.
    """

    middles: Floats
    size_m: Floats
    numbers: Floats


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
        chosen = chosen_rows(numbered(rows), drawable(rows), "cells", at_most, self)
        if chosen is None:
            return None
        cells = Cells(chosen[:, :3], size_m, chosen[:, 3])
        return Entry(read.cells.frame, read.cells.stamp_ns, cells)

    def shapes(self, content: Cells) -> dict[str, Shape]:
        """Return one surface of all tiles."""
        count = len(content.middles)
        if not count:
            return {}
        corners = content.middles[:, None] + _CORNERS * content.size_m
        colour = colour_of(rgb_of(self.values["Color"]))
        vertices = corners.reshape(-1, 3).astype(np.float32)
        return {"cells": Triangles(vertices, _faces(count), colour, self.number("Alpha"))}

    def parts_picked(self, content: Cells, picked: Picked) -> Sequence[str]:
        """Return the index of each cell; a tile has two triangles."""
        rows = picked.rows // len(_HALVES)
        inside = rows[(rows >= 0) & (rows < len(content.numbers))]
        return [str(int(one)) for one in np.unique(content.numbers[inside])]

    def part_item(self, entry: Entry[Cells], path: str, part: str) -> Item | None:
        """Return one cell."""
        row = row_of(entry.content.numbers, part)
        if row is None:
            return None
        box = box_at(entry.content.middles[row], entry.content.size_m)
        return Item("cell", part, path, entry.frame, entry.stamp_ns, box)

    def part_facts(
        self, content: Cells, part: str, message: MessageValue | None
    ) -> tuple[Fact, ...]:
        """Return its index, where it is and how large."""
        del message
        row = row_of(content.numbers, part)
        if row is None:
            return ()
        return (
            Fact("index", int(part)),
            position_fact(content.middles[row].tolist()),
            number_fact("cell_width", float(content.size_m[0]), "m"),
            number_fact("cell_height", float(content.size_m[1]), "m"),
        )


def _faces(count: int) -> NDArray[np.uint32]:
    first = np.arange(count, dtype=np.uint32) * 4
    return (first[:, None, None] + _HALVES).reshape(-1, 3)
