"""PointStampedDisplay: a point as a ball."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studio.displays.display import TopicRole, frame_and_stamp
from studio.displays.drawing import Solids
from studio.displays.history import KEPT_MAX, Entry, HistoryDisplay
from studio.displays.poses import NOT_FINITE
from studio.displays.properties import Property, colour_of, colour_properties, length, rgb_of
from studio.displays.turning import drawable

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape
    from studio.displays.turning import Floats

_NO_TURNS = np.array([[1.0, 0.0, 0.0, 0.0]], dtype=np.float32)


class PointStampedDisplay(HistoryDisplay["Floats"]):
    """Draws the last points."""

    KIND = "PointStamped"
    DOC = "A point as a ball, as somebody clicked it."
    ICON = "pin"
    TOPICS = (TopicRole("", ("geometry_msgs/msg/PointStamped",), newest_only=False),)
    PROPERTIES = (
        *colour_properties("#cc29cc", "ball"),
        length("Radius", 0.2, "How thick the ball is, from side to side."),
        Property("History Length", "whole", 1, "How many messages are shown.", 1, KEPT_MAX),
    )
    KEEPS = "History Length"
    ITEM = "point"

    def read(self, received: Received) -> Entry[Floats] | None:
        """Return the point, unless its numbers cannot be drawn."""
        message = self.decode(received)
        at = message.point
        xyz = np.array([[at.x, at.y, at.z]], dtype=np.float64)
        if not drawable(xyz).all():
            return self.refuse("not_finite", NOT_FINITE)
        return Entry(*frame_and_stamp(message.header), xyz)

    def shapes(self, content: Floats) -> dict[str, Shape]:
        """Return a ball, thick as in RViz, which takes the radius for a diameter."""
        scales = np.full((1, 3), self.values["Radius"], dtype=np.float32)
        colour = colour_of(rgb_of(self.values["Color"]))
        xyz = content.astype(np.float32)
        return {"ball": Solids("sphere", xyz, _NO_TURNS, scales, colour, self.number("Alpha"))}
