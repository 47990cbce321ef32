"""Axes: a cross of red, green and blue at a frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from studio.displays.display import Status, StillDisplay
from studio.displays.drawing import NO_TURN, NOTHING, Axes, Placed
from studio.displays.properties import FIXED_FRAME, Property
from studio.displays.selection import Item, box_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.displays.drawing import Drawing
    from studio.displays.selection import Picked

_LEAST_M = 0.0001
_PATH = "axes"


class AxesDisplay(StillDisplay):
    """Marks where a frame is, and how it is turned."""

    KIND = "Axes"
    DOC = "Shows the axes of one frame: x is red, y is green, z is blue."
    ICON = "axes"
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property("Reference Frame", "frame", FIXED_FRAME, "The frame whose axes are shown."),
        Property("Length", "number", 1.0, "Length of each axis.", low=_LEAST_M, high=1e6, unit="m"),
        Property("Radius", "number", 0.1, "Radius of each axis.", low=_LEAST_M, high=1e6, unit="m"),
        Property("Alpha", "number", 1.0, "How opaque it is: 0 is not seen.", low=0.0, high=1.0),
    )

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the frame, by the one path that there is."""
        return (picked.path,) if picked.path == _PATH else ()

    def item(self, key: str) -> Item | None:
        """Return the frame."""
        placed = self.draw(0).get(key)
        if placed is None:
            return None
        return Item("frame", placed.frame, key, placed.frame, 0, box_of(placed.shapes))

    def statuses(self) -> tuple[Status, ...]:
        """Return a warning when the axes are invisible."""
        if self.values["Alpha"]:
            return ()
        sentence = "Alpha is 0, so nothing of the axes is seen."
        return (Status("warn", "transparent", sentence, ("Alpha", 1.0)),)

    def _drawn(self) -> Drawing:
        if not self.values["Alpha"]:
            return NOTHING
        axes = Axes(
            np.zeros((1, 3), np.float32),
            np.array([NO_TURN], np.float32),
            float(self.values["Length"]),
            float(self.values["Radius"]) / 2,  # RViz takes it for the thickness, too
            float(self.values["Alpha"]),
        )
        return {_PATH: Placed(str(self.values["Reference Frame"]), 0, {"axes": axes}, follows=True)}
