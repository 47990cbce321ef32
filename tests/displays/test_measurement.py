from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.displays.measurement import (
    FluidPressureDisplay,
    IlluminanceDisplay,
    RelativeHumidityDisplay,
    TemperatureDisplay,
)
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, received
from tests.support.drawn import only, plain, said

if TYPE_CHECKING:
    from studio.displays.measurement import MeasurementDisplay

CASES: list[tuple[type[MeasurementDisplay], str, float, float]] = [
    (TemperatureDisplay, "temperature", 0.0, 100.0),
    (FluidPressureDisplay, "fluid_pressure", 98_000.0, 105_000.0),
    (IlluminanceDisplay, "illuminance", 0.0, 1000.0),
    (RelativeHumidityDisplay, "relative_humidity", 0.0, 1.0),
]


def colour(display: MeasurementDisplay, field: str, number: float, little: bool = True) -> Any:  # noqa: ANN401
    fields = {field: number}
    display.take(received(display.TOPICS[0].types[0], fields, little=little))
    return plain(only(display).shapes["points"])["colors"]


@pytest.mark.parametrize("little", [True, False])
@pytest.mark.parametrize(("kind", "field", "low", "high"), CASES)
def test_a_measurement_is_a_point_whose_colour_says_how_much(
    kind: type[MeasurementDisplay], field: str, low: float, high: float, little: bool
):
    display = kind(TYPES)
    colours = [colour(display, field, number, little) for number in (low, (low + high) / 2, high)]
    assert len({str(one) for one in colours}) == 3
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    points = plain(placed.shapes["points"])
    assert points["positions"] == [[0.0, 0.0, 0.0]]
    assert (points["size_m"], points["style"]) == (0.01, "flat squares")


def test_heat_is_red_and_cold_is_magenta():
    display = TemperatureDisplay(TYPES)
    (hot,) = colour(display, "temperature", 99.0)
    (cold,) = colour(display, "temperature", 1.0)
    assert hot[2] < 50
    assert cold[2] > 200


def test_the_ends_of_the_colours_can_be_set():
    display = IlluminanceDisplay(TYPES, {"Max Intensity": 10.0})
    assert colour(display, "illuminance", 10.0) == colour(display, "illuminance", 5000.0)
    assert colour(display, "illuminance", 10.0) != colour(display, "illuminance", 5.0)


@pytest.mark.parametrize(("kind", "field"), [case[:2] for case in CASES])
@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_a_number_that_is_none_shows_nothing_and_is_told(
    kind: type[MeasurementDisplay], field: str, number: float
):
    display = kind(TYPES)
    display.take(received(kind.TOPICS[0].types[0], {field: number}))
    assert not display.draw(NOW_NS)
    assert said(display) == [("error", "not_finite")]


def test_a_number_beyond_float32_has_the_colour_of_the_end():
    display = TemperatureDisplay(TYPES)
    assert colour(display, "temperature", 1e308) == colour(display, "temperature", 100.0)
