"""FluidPressureDisplay: the pressure of air or water, as the colour of a point at its sensor."""

from __future__ import annotations

from typing import Any

from studio.displays.display import TopicRole
from studio.displays.measurement import MeasurementDisplay, Scale, measurement_properties


class FluidPressureDisplay(MeasurementDisplay):
    """Draws the newest pressure."""

    KIND = "FluidPressure"
    DOC = "The pressure of air or water, as the colour of a point."
    TOPICS = (TopicRole("", ("sensor_msgs/msg/FluidPressure",), newest_only=False),)
    SCALE = Scale("fluid_pressure", 98_000.0, 105_000.0)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """In Pa."""
        return message.fluid_pressure
