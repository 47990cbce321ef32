"""TemperatureDisplay: a temperature, as the colour of a point at its sensor."""

from __future__ import annotations

from typing import Any

from studio.displays.display import TopicRole
from studio.displays.measurement import MeasurementDisplay, Scale, measurement_properties


class TemperatureDisplay(MeasurementDisplay):
    """Draws the newest temperature."""

    KIND = "Temperature"
    DOC = "A temperature, as the colour of a point."
    TOPICS = (TopicRole("", ("sensor_msgs/msg/Temperature",), newest_only=False),)
    SCALE = Scale("temperature", 0.0, 100.0, inverted=True)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """In degrees Celsius."""
        return message.temperature
