from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from studio.displays.vectors import AccelDisplay, TwistDisplay, WrenchDisplay
from tests.support.display_messages import STAMP_NS, TYPES, point, received
from tests.support.drawn import said, shapes_of

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.vectors import VectorDisplay

CASES: list[tuple[type[VectorDisplay], str, tuple[str, str], tuple[str, str]]] = [
    (WrenchDisplay, "wrench", ("force", "torque"), ("Force", "Torque")),
    (TwistDisplay, "twist", ("linear", "angular"), ("Linear", "Angular")),
    (AccelDisplay, "accel", ("linear", "angular"), ("Linear", "Angular")),
]


def message(
    kind: type[VectorDisplay],
    field: str,
    parts: tuple[str, str],
    *vectors: tuple[float, float, float],
    little: bool = True,
) -> Received:
    fields = {field: {part: point(*one) for part, one in zip(parts, vectors, strict=True)}}
    return received(kind.TOPICS[0].types[0], fields, little=little)


@pytest.mark.parametrize("little", [True, False])
@pytest.mark.parametrize(("kind", "field", "parts", "names"), CASES)
def test_two_vectors_are_two_arrows_in_rvizs_colours(
    kind: type[VectorDisplay],
    field: str,
    parts: tuple[str, str],
    names: tuple[str, str],
    little: bool,
):
    display = kind(TYPES)
    display.take(message(kind, field, parts, (1, 0, 0), (0, 0, 2), little=little))
    (placed,) = display.draw(0).values()
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    shapes = shapes_of(display.draw(0))
    assert shapes["straight"] == {
        "shape": "Arrows",
        "ends": [[[0.0, 0.0, 0.0], [2.6, 0.0, 0.0]]],
        "colors": [204, 51, 51],
        "shaft_diameter_m": 0.05,
        "head_diameter_m": 0.1,
        "head_length_m": 0.6,
        "opacity": 1.0,
    }
    assert shapes["turning"]["ends"] == [[[0.0, 0.0, 0.0], [0.0, 0.0, 5.2]]]
    assert shapes["turning"]["colors"] == [204, 204, 51]
    assert len(shapes["around"]["ends"]) == 28
    assert shapes["around"]["width_m"] == 0.025
    assert names[0] == kind.NAMES.straight


@pytest.mark.parametrize(("kind", "field", "parts", "names"), CASES)
def test_each_property_changes_what_is_drawn(
    kind: type[VectorDisplay], field: str, parts: tuple[str, str], names: tuple[str, str]
):
    display = kind(TYPES)
    display.take(message(kind, field, parts, (1, 0, 0), (0, 0, 2)))
    for name, value in (
        (f"{names[0]} Color", "#0000ff"), (f"{names[1]} Color", "#00ff00"), ("Alpha", 0.5),
        (f"{names[0]} Arrow Scale", 1.0), (f"{names[1]} Arrow Scale", 1.0), ("Arrow Width", 0.25),
    ):  # fmt: skip
        display.set(name, value)
    shapes = shapes_of(display.draw(0))
    straight, turning = shapes["straight"], shapes["turning"]
    assert (straight["colors"], turning["colors"]) == ([0, 0, 255], [0, 255, 0])
    assert (straight["opacity"], shapes["around"]["opacity"]) == (0.5, 0.5)
    assert straight["ends"][0][1] == [1.3, 0.0, 0.0]
    assert turning["ends"][0][1] == [0.0, 0.0, 2.6]
    assert straight["shaft_diameter_m"] == 0.025


@pytest.mark.parametrize(("kind", "field", "parts", "names"), CASES)
def test_a_short_vector_is_not_seen_and_its_display_says_how_it_would_be(
    kind: type[VectorDisplay], field: str, parts: tuple[str, str], names: tuple[str, str]
):
    display = kind(TYPES)
    display.take(message(kind, field, parts, (0.1, 0, 0), (0, 0, 0)))
    assert not display.draw(0)
    (status,) = display.statuses()
    assert (status.level, status.reason) == ("warn", "empty")
    assert status.mend is not None
    display.set(*status.mend)
    assert set(shapes_of(display.draw(0))) == {"straight"}
    assert display.statuses() == ()
    assert names[0] == kind.NAMES.straight


@pytest.mark.parametrize(("kind", "field", "parts"), [case[:3] for case in CASES])
@pytest.mark.parametrize("number", [math.nan, math.inf, 1e308])
def test_numbers_that_cannot_be_drawn_are_told(
    kind: type[VectorDisplay], field: str, parts: tuple[str, str], number: float
):
    display = kind(TYPES)
    display.take(message(kind, field, parts, (1, 0, 0), (0, number, 0)))
    assert not display.draw(0)
    assert said(display) == [("error", "not_finite")]


def test_as_many_are_seen_as_the_history_is_long():
    display = WrenchDisplay(TYPES, {"History Length": 2})
    for force in (1, 2, 3):
        display.take(
            message(WrenchDisplay, "wrench", ("force", "torque"), (force, 0, 0), (0, 0, 0))
        )
    assert len(display.draw(0)) == 2


@pytest.mark.parametrize(("kind", "field", "parts", "names"), CASES)
def test_an_arrow_of_scale_0_is_not_seen_and_its_display_says_how_it_would_be(
    kind: type[VectorDisplay], field: str, parts: tuple[str, str], names: tuple[str, str]
):
    scale = f"{names[0]} Arrow Scale"
    display = kind(TYPES, {scale: 0.0})
    assert display.statuses() == ()
    display.take(message(kind, field, parts, (1, 0, 0), (0, 0, 0)))
    assert not display.draw(0)
    (status,) = display.statuses()
    assert (status.level, status.reason, status.mend) == ("warn", "empty", (scale, 2.0))
    assert status.sentence == f"{scale} is 0, so nothing of it is seen: raise {scale}."
    display.set(scale, 2.0)
    assert display.draw(0)
    display.take(message(kind, field, parts, (0, 0, 0), (0, 0, 0)))
    assert display.statuses() == ()
