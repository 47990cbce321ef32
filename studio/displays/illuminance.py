"""IlluminanceDisplay: the brightness of light, as the colour of a point at its sensor."""

from __future__ import annotations

from typing import Any

from studio.displays.display import TopicRole
from studio.displays.measurement import MeasurementDisplay, Scale, measurement_properties


class IlluminanceDisplay(MeasurementDisplay):
    """Draws the newest illuminance."""

    KIND = "Illuminance"
    DOC = "The brightness of light, as the colour of a point."
    TOPICS = (TopicRole("", ("sensor_msgs/msg/Illuminance",), newest_only=False),)
    SCALE = Scale("illuminance", 0.0, 1000.0)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """In lx."""
        return message.illuminance
