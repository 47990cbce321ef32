"""Tiles: a large picture cut into squares, of which those that changed are painted anew."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.drawing import Picture
from studio.displays.turning import turned

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Wxyz, Xyz

TILE_CELLS: Final = 1024
"""Edge of a tile: every graphics card takes it, and a change within it is sent quickly."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """Where the cells of a map lie.

    Attributes:
        rows: Of cells, from the smallest y on.
        columns: Of cells, from the smallest x on.
        cell_m: Edge of a cell.
        corner: Where the corner of the first cell is.
        wxyz: How the map is turned about that corner.
    """

    rows: int
    columns: int
    cell_m: float
    corner: Xyz
    wxyz: Wxyz


@dataclass(frozen=True, slots=True)
class Paint:
    """What cells look like: a colour for each byte, shape (256, 4), and whether all is behind."""

    colours: NDArray[np.uint8]
    behind: bool


def paint_of(palette: NDArray[np.uint8], alpha: float, *, behind: bool) -> Paint:
    """A palette, shape (256, 4), as opaque as `alpha` says."""
    colours = palette.copy()
    colours[:, 3] = np.rint(colours[:, 3] * alpha)
    return Paint(colours, behind)


class Tiles:
    """The pictures of one map; those of cells that stayed are the same objects."""

    def __init__(self) -> None:
        self._sheet: Sheet | None = None
        self._cells: NDArray[np.int8] = np.empty((0, 0), dtype=np.int8)
        self._pictures: dict[str, Picture] = {}

    def lay(self, sheet: Sheet, cells: NDArray[np.int8]) -> None:
        """Take new cells, shape (rows, columns): pictures of the same ones stay."""
        if sheet != self._sheet:
            self._pictures.clear()
        for name, part in _parts(sheet) if self._pictures else ():
            if not np.array_equal(self._cells[part], cells[part]):
                self._pictures.pop(name, None)
        self._sheet, self._cells = sheet, cells

    def rest_on(self, cells: NDArray[np.int8]) -> None:
        """The cells are kept in another place, with the same values."""
        self._cells = cells

    def spoil(self, rows: slice, columns: slice) -> None:
        """Cells within were written over."""
        if self._sheet is None:
            return
        for name, (own_rows, own_columns) in _parts(self._sheet):
            if _meet(rows, own_rows) and _meet(columns, own_columns):
                self._pictures.pop(name, None)

    def repaint(self) -> None:
        """All looks different."""
        self._pictures.clear()

    def painted(self, paint: Paint) -> Mapping[str, Picture]:
        """All pictures by name; those that are missing are painted."""
        if self._sheet is None:
            return {}
        for name, part in _parts(self._sheet):
            if name not in self._pictures:
                self._pictures[name] = _picture(self._sheet, self._cells, part, paint)
        return dict(self._pictures)


def _parts(sheet: Sheet) -> Iterator[tuple[str, tuple[slice, slice]]]:
    """Each tile's name and where its cells are."""
    for row in range(0, sheet.rows, TILE_CELLS):
        for column in range(0, sheet.columns, TILE_CELLS):
            rows = slice(row, min(row + TILE_CELLS, sheet.rows))
            columns = slice(column, min(column + TILE_CELLS, sheet.columns))
            yield f"{row // TILE_CELLS}-{column // TILE_CELLS}", (rows, columns)


def _meet(one: slice, other: slice) -> bool:
    return one.start < other.stop and other.start < one.stop


def _picture(
    sheet: Sheet, cells: NDArray[np.int8], part: tuple[slice, slice], paint: Paint
) -> Picture:
    rows, columns = part
    shown = cells[part].view(np.uint8).copy()  # the cells are written over by updates
    at = np.array([columns.start * sheet.cell_m, rows.start * sheet.cell_m, 0.0])
    x, y, z = np.asarray(sheet.corner) + turned(np.array([sheet.wxyz]), at)[0]
    size_m = (shown.shape[1] * sheet.cell_m, shown.shape[0] * sheet.cell_m)
    at_xyz = float(x), float(y), float(z)
    return Picture(shown, size_m, at_xyz, sheet.wxyz, paint.behind, paint.colours)
