"""RelativeHumidityDisplay: the humidity of air, as the colour of a point at its sensor."""

from __future__ import annotations

from typing import Any

from studio.displays.display import TopicRole
from studio.displays.measurement import MeasurementDisplay, Scale, measurement_properties


class RelativeHumidityDisplay(MeasurementDisplay):
    """Draws the newest humidity."""

    KIND = "RelativeHumidity"
    DOC = "The humidity of air, as the colour of a point."
    TOPICS = (TopicRole("", ("sensor_msgs/msg/RelativeHumidity",), newest_only=False),)
    SCALE = Scale("relative_humidity", 0.0, 1.0)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """From 0 to 1."""
        return message.relative_humidity
