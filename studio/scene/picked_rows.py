"""What a page points at in the nodes of a shape, as rows of the shape: `nodes_of` the other way."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studio.displays.drawing import Arrows, Lines, Points, Solids, Triangles
from studio.scene.solids import level_of_node, levels_of, whole_and_short
from studio.scene.surfaces import drawn_faces

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import Shape


def rows_of(shape: Shape, node: str, rows: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return which rows of a shape the rows of one of its nodes are.

    Args:
        shape: As it is drawn.
        node: The last part of the name of the node.
        rows: Shape (N,): of the node's points, lines, solids or faces; those beyond what it has
            are left out.

    Returns:
        The rows, or the numbers of their `items` if the shape has them; ascending, each once.
    """
    drawn = _drawn_of(shape, node)
    rows = np.unique(rows)
    if drawn is not None:
        rows = drawn[rows[(rows >= 0) & (rows < len(drawn))]]
    items = shape.items if isinstance(shape, Points | Lines | Solids | Triangles) else None
    if items is None:
        return rows
    return np.unique(items[rows[(rows >= 0) & (rows < len(items))]])


def _drawn_of(shape: Shape, node: str) -> NDArray[np.intp] | None:
    """Return which rows of a shape a node draws, in its order; None: all."""
    match shape:
        case Lines():
            chosen = np.isfinite(shape.ends).all(axis=(1, 2))
        case Arrows():
            chosen = whole_and_short(shape)[0 if node == "arrows" else 1]
        case Solids():
            levels = levels_of(shape)
            if levels.ndim == 0:
                return None
            chosen = levels == level_of_node(node)
        case Triangles():
            return drawn_faces(shape)
        case _:
            return None
    return None if chosen.all() else np.flatnonzero(chosen)
