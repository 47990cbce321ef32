"""Temperature, FluidPressure, Illuminance, RelativeHumidity: a number as the colour of a point."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from studio.displays.cloud import Cloud
from studio.displays.cloud_display import CLOUD_PROPERTIES, INTENSITY, CloudDisplay
from studio.displays.display import Status, TopicRole, stamp_ns_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Limits, Received
    from studio.displays.properties import Property

_AT_ORIGIN = np.zeros((1, 3), dtype=np.float32)
_NO_POINTS = np.zeros((0, 3), dtype=np.float32)


class Scale(NamedTuple):
    """Default colours of a measurement: the field of its message, and the bounds."""

    field: str
    low: float
    high: float
    inverted: bool = False


def measurement_properties(scale: Scale) -> tuple[Property, ...]:
    """Return the properties of clouds, with the colours of a scale."""
    first = {
        "Color Transformer": INTENSITY,
        "Channel Name": scale.field,
        "Autocompute Intensity Bounds": False,
        "Invert Rainbow": scale.inverted,
        "Min Intensity": scale.low,
        "Max Intensity": scale.high,
    }
    return tuple(replace(one, default=first.get(one.name, one.default)) for one in CLOUD_PROPERTIES)


class MeasurementDisplay(CloudDisplay):
    """Draws one point at the origin of the sensor; derived classes return the number it shows."""

    SCALE: ClassVar[Scale]

    @abstractmethod
    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """Return the number of a message."""

    def read(self, received: Received, limits: Limits) -> Cloud:
        """Return a point, unless the number is none."""
        del limits
        message = self.decode(received)
        number = float(self.measured(message))
        finite = bool(np.isfinite(number))
        return Cloud(
            message.header.frame_id,
            stamp_ns_of(message.header),
            _AT_ORIGIN if finite else _NO_POINTS,
            None,
            int(finite),
            _Channel(self.SCALE.field, number),
            None if finite else self._not_finite(number),
        )

    def _not_finite(self, number: float) -> Status:
        what = self.SCALE.field.replace("_", " ")
        sentence = f"The {what} is {number:g}, which has no colour: nothing is drawn."
        return Status("error", "not_finite", sentence)


class _Channel:
    """The one number, as a cloud has it."""

    size_bytes = 8

    def __init__(self, name: str, number: float) -> None:
        self.names: tuple[str, ...] = (name,)
        # Colours are all one beyond the range of float32.
        self._number = float(np.clip(number, -3e38, 3e38))

    def numbers(self, name: str, raw: NDArray[np.intp] | None) -> NDArray[np.float32] | None:
        """The number under its name."""
        del raw
        return np.array([self._number], dtype=np.float32) if name in self.names else None

    def colours(self, raw: NDArray[np.intp] | None) -> None:
        """None are sent."""
        del raw

    def float_colours(self, raw: NDArray[np.intp] | None) -> None:
        """None are sent."""
        del raw


class TemperatureDisplay(MeasurementDisplay):
    """Draws the newest temperature."""

    KIND = "Temperature"
    DOC = "A temperature, as the colour of a point."
    ICON = "thermometer"
    TOPICS = (TopicRole("", ("sensor_msgs/msg/Temperature",), newest_only=False),)
    SCALE = Scale("temperature", 0.0, 100.0, inverted=True)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """Return degrees Celsius."""
        return message.temperature


class FluidPressureDisplay(MeasurementDisplay):
    """Draws the newest pressure."""

    KIND = "FluidPressure"
    DOC = "The pressure of air or water, as the colour of a point."
    ICON = "joints"
    TOPICS = (TopicRole("", ("sensor_msgs/msg/FluidPressure",), newest_only=False),)
    SCALE = Scale("fluid_pressure", 98_000.0, 105_000.0)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """Return Pa."""
        return message.fluid_pressure


class IlluminanceDisplay(MeasurementDisplay):
    """Draws the newest illuminance."""

    KIND = "Illuminance"
    DOC = "The brightness of light, as the colour of a point."
    ICON = "sun"
    TOPICS = (TopicRole("", ("sensor_msgs/msg/Illuminance",), newest_only=False),)
    SCALE = Scale("illuminance", 0.0, 1000.0)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """Return lx."""
        return message.illuminance


class RelativeHumidityDisplay(MeasurementDisplay):
    """Draws the newest humidity."""

    KIND = "RelativeHumidity"
    DOC = "The humidity of air, as the colour of a point."
    ICON = "humidity"
    TOPICS = (TopicRole("", ("sensor_msgs/msg/RelativeHumidity",), newest_only=False),)
    SCALE = Scale("relative_humidity", 0.0, 1.0)
    PROPERTIES = measurement_properties(SCALE)

    def measured(self, message: Any) -> float:  # noqa: ANN401 - a message
        """Return a share, 0 to 1."""
        return message.relative_humidity
