"""Grid: lines at even distances, on a plane of a frame or in layers above it."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from studio.displays.display import Status, StillDisplay
from studio.displays.drawing import NOTHING, GridLines, Lines, Placed
from studio.displays.properties import FIXED_FRAME, Property, rgb_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.displays.drawing import Drawing, GridPlane, Shape, Xyz
    from studio.displays.properties import Value
    from studio.displays.selection import Picked

_CELLS_MAX: Final = 1000
_LAYERS_MAX: Final = 100
_UPRIGHTS_MAX: Final = 50_000
_OFFSET_MAX_M: Final = 1e6
_AXES: Final[dict[str, tuple[GridPlane, tuple[int, int, int]]]] = {
    "XY": ("xy", (0, 1, 2)),
    "XZ": ("xz", (0, 2, 1)),
    "YZ": ("yz", (1, 2, 0)),
}
"""For each plane its two axes, and the normal."""


def _offset(axis: str) -> Property:
    doc = f"How far the grid is moved along {axis.lower()}."
    return Property(
        f"Offset/{axis}", "number", 0.0, doc, low=-_OFFSET_MAX_M, high=_OFFSET_MAX_M, unit="m"
    )


class GridDisplay(StillDisplay):
    """A grid is centred on its frame; with layers it is a lattice."""

    KIND = "Grid"
    DOC = "Shows a grid of lines on a plane of a frame."
    ICON = "grid"
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property("Reference Frame", "frame", FIXED_FRAME, "The frame in which the grid lies."),
        Property(
            "Plane Cell Count", "whole", 10, "How many cells each edge has.", low=1, high=_CELLS_MAX
        ),
        Property(
            "Normal Cell Count",
            "whole",
            0,
            "How many cells lie over one another; 0 draws one plane.",
            low=0,
            high=_LAYERS_MAX,
        ),
        Property("Cell Size", "number", 1.0, "Edge of a cell.", low=0.0001, high=1e5, unit="m"),
        Property(
            "Line Style",
            "choice",
            "Lines",
            "Thin lines, or bands of a width in the scene.",
            choices=("Lines", "Billboards"),
        ),
        Property(
            "Line Width",
            "number",
            0.03,
            "Width of the bands.",
            low=0.001,
            high=1000.0,
            unit="m",
            when=("Line Style", ("Billboards",)),
        ),
        Property("Color", "colour", "#a0a0a4", "Colour of the lines."),
        Property("Alpha", "number", 0.5, "How opaque it is: 0 is not seen.", low=0.0, high=1.0),
        Property(
            "Plane", "choice", "XY", "The two axes that the grid spans.", choices=tuple(_AXES)
        ),
        _offset("X"),
        _offset("Y"),
        _offset("Z"),
    )

    def statuses(self) -> tuple[Status, ...]:
        """Return warnings when it is invisible, or lines are left out."""
        if not self.values["Alpha"]:
            sentence = "Alpha is 0, so nothing of the grid is seen."
            return (Status("warn", "transparent", sentence, ("Alpha", 0.5)),)
        if self._layers and self._uprights > _UPRIGHTS_MAX:
            sentence = f"{self._uprights} lines between the layers are too many, and are left out."
            mend: tuple[str, Value] = ("Plane Cell Count", 100)
            return (Status("warn", "unsupported", sentence, mend),)
        return ()

    @property
    def _cells(self) -> int:
        return int(self.values["Plane Cell Count"])

    @property
    def _layers(self) -> int:
        return int(self.values["Normal Cell Count"])

    @property
    def _uprights(self) -> int:
        return (self._cells + 1) ** 2

    @property
    def _width_m(self) -> float:
        is_thin = self.values["Line Style"] == "Lines"
        return 0.0 if is_thin else float(self.values["Line Width"])

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return nothing: lines of a grid are in the way of whoever selects something else."""
        del picked
        return ()

    def _drawn(self) -> Drawing:
        if not self.values["Alpha"]:
            return NOTHING
        plane, (_, _, across) = _AXES[str(self.values["Plane"])]
        shapes: dict[str, Shape] = {}
        for layer in range(self._layers + 1):
            shapes[f"layer_{layer}"] = GridLines(
                plane,
                self._cells,
                float(self.values["Cell Size"]),
                self._width_m,
                rgb_of(self.values["Color"]),
                float(self.values["Alpha"]),
                self._position(across, layer),
            )
        if self._layers and self._uprights <= _UPRIGHTS_MAX:
            shapes["uprights"] = self._upright_lines()
        return {"grid": Placed(str(self.values["Reference Frame"]), 0, shapes, follows=True)}

    def _position(self, across: int, layer: int) -> Xyz:
        """Return the centre of a layer: they lie evenly to both sides."""
        position = [float(self.values[f"Offset/{axis}"]) for axis in "XYZ"]
        position[across] += (layer - self._layers / 2) * float(self.values["Cell Size"])
        return position[0], position[1], position[2]

    def _upright_lines(self) -> Lines:
        """Return lines through all layers, at each corner of the cells."""
        first, second, across = _AXES[str(self.values["Plane"])][1]
        size_m = float(self.values["Cell Size"])
        places = (np.arange(self._cells + 1) - self._cells / 2) * size_m
        ends = np.zeros((self._uprights, 2, 3), np.float32)
        ends[:, :, first] = np.repeat(places, len(places))[:, None]
        ends[:, :, second] = np.tile(places, len(places))[:, None]
        ends[:, :, across] = np.array([-0.5, 0.5]) * self._layers * size_m
        ends += np.array([float(self.values[f"Offset/{axis}"]) for axis in "XYZ"], np.float32)
        colour = np.array(rgb_of(self.values["Color"]), np.uint8)
        return Lines(ends, colour, self._width_m, float(self.values["Alpha"]))
