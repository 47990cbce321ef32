"""Map: an occupancy grid on the ground, in RViz's colours, and what changes of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from studio.displays.cloud import stamp_of
from studio.displays.display import Status, StillDisplay, TopicRole
from studio.displays.drawing import NOTHING, Placed
from studio.displays.grid_tiles import Sheet, Tiles, paint_of
from studio.displays.map_palettes import SCHEMES, palette
from studio.displays.properties import Property
from studio.displays.reading import reading
from studio.displays.turning import drawable, unit_quaternions
from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.display import Received
    from studio.displays.drawing import Drawing
    from studio.displays.properties import Value
    from studio.ros.types.library import TypeLibrary

_CELLS_MAX: Final = 256 << 20
_UPDATES: Final = "updates"


@dataclass(slots=True, eq=False)
class _Grid:
    """A map as it came, and as it is shown: of too many cells the highest of each square."""

    frame: str
    stamp_ns: int
    cells: NDArray[np.int8]
    step: int
    shown: NDArray[np.int8]


class MapDisplay(StillDisplay):
    """Draws the newest map; updates of a part of it paint the tiles that they touch."""

    KIND: ClassVar[str] = "Map"
    DOC: ClassVar[str] = "Which places are free and which are occupied, as a picture on the ground."
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
        """Take in a map, or a part of one; parts that come before any map are passed over.

        Raises:
            StudioError: It cannot be read, or makes no sense.
        """
        message = self.decode(received)
        with reading(received.type_name):
            if role != _UPDATES:
                self._take_map(message)
            elif self._grid is not None:
                self._take_update(self._grid, message)
        self.redraw()

    def changed(self, name: str) -> None:
        """Look different from now on."""
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
        return {"map": Placed(self._grid.frame, stamp_ns, shapes, follows=not fixed)}

    def _take_map(self, message: Any) -> None:  # noqa: ANN401 - a nav_msgs/OccupancyGrid
        cells = _cells(message.info, message.data, "OccupancyGrid")
        step = _step(cells.size, self.limits.cells)
        shown = _pooled(cells, step)
        sheet = _sheet(message.info, shown, step)
        frame = message.header.frame_id or "map"
        self._tiles.lay(sheet, shown)
        self._grid = _Grid(frame, stamp_of(message.header), cells, step, shown)

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
        # The two topics come as they like: what the map knows already would undo it.
        if not part.size or 0 < stamp_of(message.header) < grid.stamp_ns:
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


def _step(count: int, limit: int) -> int:
    """Edge of the squares of cells that are shown as one, so that the limit holds."""
    return max(1, int(np.ceil(np.sqrt(count / max(limit, 1)))))


def _pooled(cells: NDArray[np.int8], step: int) -> NDArray[np.int8]:
    """The highest of each square of cells, so that no obstacle goes; unknown is below free."""
    if step == 1 or not cells.size:
        return cells
    rows, columns = _starts(cells.shape[0], step), _starts(cells.shape[1], step)
    return np.maximum.reduceat(np.maximum.reduceat(cells, rows, axis=0), columns, axis=1)


def _starts(count: int, step: int) -> NDArray[np.intp]:
    return np.arange(0, count, step)


def _whole(part: slice, step: int) -> slice:
    """The squares that cells lie in."""
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
