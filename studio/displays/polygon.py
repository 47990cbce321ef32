"""PolygonDisplay: the outline of an area."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.display import TopicRole
from studio.displays.drawing import Lines
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import chosen_rows
from studio.displays.properties import RVIZ_GREEN, colour_of, colour_properties, rgb_of
from studio.displays.turning import drawable
from studio.ros.columns.poses import POLYGON, read_polygon

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.turning import Floats

CORNERS_MAX: Final = 100_000


class PolygonDisplay(HistoryDisplay["Floats"]):
    """Draws the newest polygon."""

    KIND = "Polygon"
    DOC = "The outline of an area, as the footprint of a robot is."
    ICON = "polygon"
    TOPICS = (TopicRole("", (POLYGON,)),)
    PROPERTIES = colour_properties(RVIZ_GREEN, "outline")

    def read(self, received: Received) -> Entry[Floats] | None:
        """Return the corners that can be drawn."""
        read = read_polygon(received.cdr)
        at_most = min(CORNERS_MAX, self.limits.points)
        corners = chosen_rows(read.rows, drawable(read.rows), "corners", at_most, self)
        if corners is None:
            return None
        if len(corners) == 1:
            self.warn("empty", "The polygon has a single corner: an outline needs two.")
        return Entry(read.frame, read.stamp_ns, corners)

    def shapes(self, content: Floats) -> dict[str, Shape]:
        """Return a line from each corner to the next, and back to the first."""
        if len(content) < 2:
            return {}
        ends = np.stack((content, np.roll(content, -1, axis=0)), axis=1).astype(np.float32)
        colour = colour_of(rgb_of(self.values["Color"]))
        return {"outline": Lines(ends, colour, 0.0, self.number("Alpha"))}
