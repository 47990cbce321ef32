"""RangeDisplay: what a distance sensor sees, as a cone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from studio.displays.display import TopicRole, frame_and_stamp
from studio.displays.drawing import Solids
from studio.displays.history import KEPT_MAX, Entry, HistoryDisplay
from studio.displays.properties import Property, colour_of, rgb_of
from studio.displays.turning import FAR

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape

# A cone stands on its tip along z; this lays it along x.
_LYING = np.array([[math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0]], dtype=np.float32)


class Cone(NamedTuple):
    """A cone along x with its tip at the origin; of no length when nothing was in range."""

    length_m: float
    width_m: float


class RangeDisplay(HistoryDisplay[Cone]):
    """Draws the last ranges."""

    KIND = "Range"
    DOC = "What an ultrasonic or infrared sensor sees, as a cone."
    ICON = "cone"
    TOPICS = (TopicRole("", ("sensor_msgs/msg/Range",), newest_only=False),)
    PROPERTIES = (
        Property("Color", "colour", "#ffffff", "Colour of the cone."),
        Property("Alpha", "number", 0.5, "How opaque the cone is.", 0.0, 1.0),
        Property("Buffer Length", "whole", 1, "How many messages are shown.", 1, KEPT_MAX),
    )
    KEEPS = "Buffer Length"

    def read(self, received: Received) -> Entry[Cone] | None:
        """Return the cone; a range that is none takes a place and shows nothing, as in RViz."""
        message = self.decode(received)
        length_m = _length_m(message)
        width_m = 2.0 * length_m * math.tan(_half_angle_rad(message.field_of_view))
        if length_m == 0:
            self.warn("out_of_range", _why_nothing(message))
        elif not 0 < width_m <= FAR or length_m > FAR:
            return self.refuse(
                "out_of_range",
                f"The field of view, {message.field_of_view:g} rad, makes no cone: it is between 0 "
                "and pi.",
            )
        return Entry(*frame_and_stamp(message.header), Cone(length_m, width_m))

    def shapes(self, content: Cone) -> dict[str, Shape]:
        """Return one cone."""
        if content.length_m == 0:
            return {}
        scales = np.array([[content.width_m, content.width_m, content.length_m]], dtype=np.float32)
        colour = colour_of(rgb_of(self.values["Color"]))
        tip = np.zeros((1, 3), dtype=np.float32)
        return {"cone": Solids("cone", tip, _LYING, scales, colour, self.number("Alpha"))}


def _length_m(message: Any) -> float:  # noqa: ANN401 - a message
    """Return the range within its limits, or the distance of a sensor that only detects.

    Such a sensor reports an object as -inf, and none as inf (REP 117).
    """
    if message.min_range <= message.range <= message.max_range and math.isfinite(message.range):
        return max(0.0, message.range)
    if message.min_range == message.max_range and message.range == -math.inf:
        return max(0.0, message.min_range) if math.isfinite(message.min_range) else 0.0
    return 0.0


def _half_angle_rad(field_of_view_rad: float) -> float:
    """Half of the angle between the sides; 0 for what is none, which makes no cone."""
    return field_of_view_rad / 2 if 0 < field_of_view_rad < math.pi else 0.0


def _why_nothing(message: Any) -> str:  # noqa: ANN401 - a message
    if message.range == 0:
        return "The range is 0 m: a cone of no length cannot be seen."
    return (
        f"The range, {message.range:g} m, is not within {message.min_range:g} to "
        f"{message.max_range:g} m, as the sensor gives its limits: nothing is in range."
    )
