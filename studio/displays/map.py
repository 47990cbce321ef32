"""Map: an occupancy grid as tiles of a picture on the ground, in RViz's colours."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from studio.displays.display import Status, StillDisplay, TopicRole, reading_fields, stamp_ns_of
from studio.displays.drawing import NOTHING, Picture, Placed
from studio.displays.properties import Property
from studio.displays.selection import (
    Box,
    Fact,
    Item,
    box_at,
    index_of,
    number_fact,
    orientation_fact,
    position_fact,
)
from studio.displays.turning import drawable, turned, unit_quaternions
from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from studio.displays.display import Received
    from studio.displays.drawing import Drawing, Wxyz, Xyz
    from studio.displays.properties import Value
    from studio.displays.selection import Picked
    from studio.ros.types.library import TypeLibrary

SCHEMES: Final = ("map", "costmap", "raw")
_UNKNOWN: Final = (0x70, 0x89, 0x86)
TILE_CELLS: Final = 1024
"""Edge of a tile: every graphics card takes it, and a change within it is sent quickly."""
_CELLS_MAX: Final = 256 << 20
_UPDATES: Final = "updates"
_PATH: Final = "map"
_WHOLE: Final = "map"
"""Key of the map as a whole; that of a cell is its row and column."""


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


@dataclass(frozen=True, slots=True)
class Sheet:
    """Geometry of a map's cells.

    Attributes:
        rows: Number, from the smallest y on.
        columns: Number, from the smallest x on.
        cell_m: Edge of a cell.
        corner: Position of the first cell's corner.
        wxyz: Rotation of the map about that corner.
    """

    rows: int
    columns: int
    cell_m: float
    corner: Xyz
    wxyz: Wxyz


@dataclass(frozen=True, slots=True)
class Paint:
    """A colour for each value of a cell, shape (256, 4), and whether the map is behind all else."""

    colours: NDArray[np.uint8]
    behind: bool


def paint_of(palette: NDArray[np.uint8], alpha: float, *, behind: bool) -> Paint:
    """Return a palette, shape (256, 4), with the opacity `alpha`."""
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
        """Use another array with the same values."""
        self._cells = cells

    def spoil(self, rows: slice, columns: slice) -> None:
        """Forget the tiles of cells that were written over."""
        if self._sheet is None:
            return
        for name, (own_rows, own_columns) in _parts(self._sheet):
            if _overlap(rows, own_rows) and _overlap(columns, own_columns):
                self._pictures.pop(name, None)

    def repaint(self) -> None:
        """Forget all tiles."""
        self._pictures.clear()

    def painted(self, paint: Paint) -> Mapping[str, Picture]:
        """Return all pictures by name; those that are missing are painted."""
        if self._sheet is None:
            return {}
        for name, part in _parts(self._sheet):
            if name not in self._pictures:
                self._pictures[name] = _picture(self._sheet, self._cells, part, paint)
        return dict(self._pictures)


def _parts(sheet: Sheet) -> Iterator[tuple[str, tuple[slice, slice]]]:
    """Yield each tile's name and cells."""
    for row in range(0, sheet.rows, TILE_CELLS):
        for column in range(0, sheet.columns, TILE_CELLS):
            rows = slice(row, min(row + TILE_CELLS, sheet.rows))
            columns = slice(column, min(column + TILE_CELLS, sheet.columns))
            yield f"{row // TILE_CELLS}-{column // TILE_CELLS}", (rows, columns)


def _overlap(one: slice, other: slice) -> bool:
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


@dataclass(slots=True, eq=False)
class _Grid:
    """A map as it came, and as it is shown: of too many cells the highest of each square."""

    frame: str
    stamp_ns: int
    cells: NDArray[np.int8]
    step: int
    shown: NDArray[np.int8]
    sheet: Sheet
    """Of the cells as they came."""


class MapDisplay(StillDisplay):
    """Draws the newest map; updates of a part of it paint the tiles that they touch."""

    KIND: ClassVar[str] = "Map"
    DOC: ClassVar[str] = "Which places are free and which are occupied, as a picture on the ground."
    ICON: ClassVar[str] = "map"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("nav_msgs/msg/OccupancyGrid",), latched=True),
        TopicRole(
            _UPDATES,
            ("map_msgs/msg/OccupancyGridUpdate",),
            beside="_updates",
            newest_only=False,
            depth=100,
        ),
    )
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property("Alpha", "number", 0.7, "How opaque the map is.", low=0.0, high=1.0),
        Property(
            "Color Scheme", "choice", "map", "Which colours the values have.", choices=SCHEMES
        ),
        Property(
            "Draw Behind", "switch", False,  # noqa: FBT003 - its first value
            "Whether everything else is drawn over the map.",
        ),
        Property(
            "Use Timestamp", "switch", False,  # noqa: FBT003
            "Whether the map stays where its frame was at its stamp; else it moves with the frame.",
        ),
        Property(
            "Binary representation", "switch", False,  # noqa: FBT003
            "Whether cells are either free or occupied.",
        ),
        Property(
            "Binary threshold", "whole", 100, "From which value on a cell is occupied.", low=0,
            high=100, when=("Binary representation", (True,)),
        ),
    )  # fmt: skip

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._grid: _Grid | None = None
        self._tiles = Tiles()

    def take(self, received: Received, role: str = "") -> None:
        """Take a map, or a part of one; parts that come before any map are ignored.

        Raises:
            StudioError: It cannot be read, or makes no sense.
        """
        message = self.decode(received)
        with reading_fields(received.type_name):
            if role != _UPDATES:
                self._take_map(message)
            elif self._grid is not None:
                self._take_update(self._grid, message)
        self.redraw()

    def changed(self, name: str) -> None:
        """Take new settings."""
        if name != "Use Timestamp":
            self._tiles.repaint()
        self.redraw()

    def reset(self) -> None:
        """Forget the map."""
        self._grid = None
        self._tiles = Tiles()
        self.redraw()

    def statuses(self) -> tuple[Status, ...]:
        """Why no map is seen, or not all of it."""
        if self._grid is None:
            return ()
        found = (self._empty(self._grid), self._transparent(), _pooled_status(self._grid))
        return tuple(one for one in found if one is not None)

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the cell that was hit, or the map as a whole."""
        if self._grid is None or not self._grid.cells.size:
            return ()
        if picked.place is None:
            return (_WHOLE,)
        sheet = self._grid.sheet
        row, column = _cell_at(sheet, picked.place)
        inside = 0 <= row < sheet.rows and 0 <= column < sheet.columns
        return (f"{row}/{column}",) if inside else ()

    def item(self, key: str) -> Item | None:
        """Return a cell, or the map."""
        grid = self._grid
        if grid is None or not grid.cells.size:
            return None
        sheet = grid.sheet
        if key == _WHOLE:
            whole = _box_of_cells(sheet, (0, 0), (sheet.rows, sheet.columns))
            return Item("map", "", _PATH, grid.frame, grid.stamp_ns, whole)
        cell = _cell_of(sheet, key)
        if cell is None:
            return None
        box = _box_of_cells(sheet, cell, (1, 1))
        return Item("cell", f"{cell[0]}, {cell[1]}", _PATH, grid.frame, grid.stamp_ns, box)

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return row, column and value of a cell; of the map its size and origin."""
        grid = self._grid
        if grid is None:
            return ()
        sheet = grid.sheet
        if key == _WHOLE:
            return (
                Fact("width", sheet.columns), Fact("height", sheet.rows),
                number_fact("resolution", sheet.cell_m, "m"),
                position_fact(sheet.corner), orientation_fact(sheet.wxyz),
            )  # fmt: skip
        cell = _cell_of(sheet, key)
        if cell is None:
            return ()
        row, column = cell
        return (
            Fact("row", row), Fact("column", column), Fact("index", row * sheet.columns + column),
            Fact("value", int(grid.cells[row, column])),
            position_fact(_box_of_cells(sheet, cell, (1, 1)).middle),
        )  # fmt: skip

    def _drawn(self) -> Drawing:
        if self._grid is None or not self._grid.cells.size:
            return NOTHING
        fixed = bool(self.values["Use Timestamp"])
        threshold = self.values["Binary threshold"]
        colours = palette(
            str(self.values["Color Scheme"]),
            int(threshold) if self.values["Binary representation"] else None,
        )
        behind = bool(self.values["Draw Behind"])
        paint = paint_of(colours, float(self.values["Alpha"]), behind=behind)
        stamp_ns = self._grid.stamp_ns if fixed else 0
        shapes = self._tiles.painted(paint)
        return {_PATH: Placed(self._grid.frame, stamp_ns, shapes, follows=not fixed)}

    def _take_map(self, message: Any) -> None:  # noqa: ANN401 - a nav_msgs/OccupancyGrid
        cells = _cells(message.info, message.data, "OccupancyGrid")
        step = _step(cells.size, self.limits.cells)
        shown = _pooled(cells, step)
        sheet = _sheet(message.info, shown, step)
        frame = message.header.frame_id or "map"
        self._tiles.lay(sheet, shown)
        whole = _sheet(message.info, cells, 1)
        self._grid = _Grid(frame, stamp_ns_of(message.header), cells, step, shown, whole)

    def _take_update(self, grid: _Grid, message: Any) -> None:  # noqa: ANN401
        part = _cells(message, message.data, "OccupancyGridUpdate")
        (rows, columns), (x, y) = part.shape, (int(message.x), int(message.y))
        height, width = grid.cells.shape
        if x < 0 or y < 0 or x + columns > width or y + rows > height:
            raise DisplayMessageError(
                "OccupancyGridUpdate",
                f"its {columns:,} x {rows:,} cells at {x:,}, {y:,} reach beyond the map of "
                f"{width:,} x {height:,}",
            )
        # The two topics are not in order: an update older than the map would undo it.
        if not part.size or 0 < stamp_ns_of(message.header) < grid.stamp_ns:
            return
        grid.cells = _own(grid.cells)
        grid.cells[y : y + rows, x : x + columns] = part
        self._show(grid, slice(y, y + rows), slice(x, x + columns))

    def _show(self, grid: _Grid, rows: slice, columns: slice) -> None:
        """Carry cells over to what is shown of them."""
        step = grid.step
        if step == 1:
            grid.shown = grid.cells
            self._tiles.rest_on(grid.shown)
            self._tiles.spoil(rows, columns)
            return
        rows, columns = _whole(rows, step), _whole(columns, step)
        part = grid.cells[
            rows.start * step : rows.stop * step, columns.start * step : columns.stop * step
        ]
        grid.shown[rows, columns] = _pooled(part, step)
        self._tiles.spoil(rows, columns)

    def _empty(self, grid: _Grid) -> Status | None:
        height, width = grid.cells.shape
        if not grid.cells.size:
            return Status("warn", "empty", f"The map has no cells: it is {width:,} x {height:,}.")
        costs = self.values["Color Scheme"] == "costmap"
        if costs and not self.values["Binary representation"] and not grid.shown.any():
            sentence = 'All cells are 0, which is transparent in the colours of "costmap".'
            return Status("warn", "transparent", sentence, ("Color Scheme", "map"))
        return None

    def _transparent(self) -> Status | None:
        if float(self.values["Alpha"]) > 0.0:
            return None
        return Status("warn", "transparent", "Alpha is 0: nothing is seen.", ("Alpha", 0.7))


def _cells(size: Any, data: NDArray[np.int8], kind: str) -> NDArray[np.int8]:  # noqa: ANN401
    """Cells as rows from the smallest y on, a view of the data."""
    width, height = int(size.width), int(size.height)
    if width * height > _CELLS_MAX:
        raise DisplayMessageError(
            kind, f"it has {width:,} x {height:,} cells, at most {_CELLS_MAX:,} are drawn"
        )
    if width * height != len(data):
        raise DisplayMessageError(
            kind, f"{width:,} x {height:,} cells need as many values, and it has {len(data):,}"
        )
    return data.reshape(height, width)


def _sheet(info: Any, shown: NDArray[np.int8], step: int) -> Sheet:  # noqa: ANN401
    place, turn = info.origin.position, info.origin.orientation
    pose = np.array([[place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z]])
    if not drawable(pose).all():
        raise DisplayMessageError("OccupancyGrid", "its origin is NaN, infinite or out of reach")
    resolution_m = float(info.resolution)
    if not 0.0 < resolution_m <= 1e6:
        raise DisplayMessageError("OccupancyGrid", f"its resolution is {resolution_m:g} m")
    x, y, z = (float(part) for part in pose[0, :3])
    wxyz = unit_quaternions(pose[:, 3:])[0][0]
    turned = (float(wxyz[0]), float(wxyz[1]), float(wxyz[2]), float(wxyz[3]))
    return Sheet(shown.shape[0], shown.shape[1], resolution_m * step, (x, y, z), turned)


def _cell_at(sheet: Sheet, place: Xyz) -> tuple[int, int]:
    """Return row and column at a place in the frame of the map; they may be beyond the map."""
    w, x, y, z = sheet.wxyz
    back = turned(np.array([[w, -x, -y, -z]]), np.subtract(place, sheet.corner))[0] / sheet.cell_m
    column, row = np.clip(np.floor(back[:2]), -1, 1 << 40).astype(int).tolist()
    return row, column


def _cell_of(sheet: Sheet, key: str) -> tuple[int, int] | None:
    row, column = (index_of(part) for part in (*key.split("/", 1), "")[:2])
    return (row, column) if 0 <= row < sheet.rows and 0 <= column < sheet.columns else None


def _box_of_cells(sheet: Sheet, cell: tuple[int, int], count: tuple[int, int]) -> Box:
    """Return a flat box around so many rows and columns from a cell on."""
    (row, column), (rows, columns) = cell, count
    middle = np.array([column + columns / 2, row + rows / 2, 0.0]) * sheet.cell_m
    at = np.asarray(sheet.corner) + turned(np.array([sheet.wxyz]), middle)[0]
    return box_at(at, (columns * sheet.cell_m, rows * sheet.cell_m, 0.0), sheet.wxyz)


def _step(count: int, limit: int) -> int:
    """Edge of the squares of cells that are shown as one, so that the limit holds."""
    return max(1, int(np.ceil(np.sqrt(count / max(limit, 1)))))


def _pooled(cells: NDArray[np.int8], step: int) -> NDArray[np.int8]:
    """Return the highest of each square of cells; unknown counts as less than free."""
    if step == 1 or not cells.size:
        return cells
    rows, columns = _starts(cells.shape[0], step), _starts(cells.shape[1], step)
    return np.maximum.reduceat(np.maximum.reduceat(cells, rows, axis=0), columns, axis=1)


def _starts(count: int, step: int) -> NDArray[np.intp]:
    return np.arange(0, count, step)


def _whole(part: slice, step: int) -> slice:
    """Return the squares that cells lie in."""
    return slice(part.start // step, -(-part.stop // step))


def _own(cells: NDArray[np.int8]) -> NDArray[np.int8]:
    return cells if cells.flags.writeable else cells.copy()


def _pooled_status(grid: _Grid) -> Status | None:
    if grid.step == 1:
        return None
    height, width = grid.cells.shape
    sentence = (
        f"Showing the highest of every {grid.step} x {grid.step} cells of {width:,} x {height:,}."
    )
    return Status("ok", "thinned", sentence)
