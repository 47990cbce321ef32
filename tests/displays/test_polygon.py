from __future__ import annotations

import math
from typing import Any

import pytest

from studio.displays.polygon import PolygonDisplay
from tests.support.display_messages import STAMP_NS, TYPES, point, received
from tests.support.drawn import only, said, shapes_of

TYPE = "geometry_msgs/msg/PolygonStamped"
TRIANGLE = [point(0.0, 0.0, 0.0), point(1.0, 0.0, 0.0), point(0.0, 1.0, 0.25)]


def display_of(points: list[dict[str, Any]], little: bool = True) -> PolygonDisplay:
    display = PolygonDisplay(TYPES)
    display.take(received(TYPE, {"polygon": {"points": points}}, little=little))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_a_polygon_is_a_closed_line(little: bool):
    display = display_of(TRIANGLE, little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    assert shapes_of(display.draw(0)) == {
        "outline": {
            "shape": "Lines",
            "ends": [
                [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.25]],
                [[0.0, 1.0, 0.25], [0.0, 0.0, 0.0]],
            ],
            "colors": [25, 255, 0],
            "width_m": 0.0,
            "opacity": 1.0,
        }
    }


@pytest.mark.parametrize(
    ("points", "status"),
    [
        ([], ("warn", "empty")),
        (TRIANGLE[:1], ("warn", "empty")),
        ([point(math.nan, 0.0, 0.0)] * 3, ("error", "not_finite")),
    ],
)
def test_why_nothing_is_seen_is_told(points: list[dict[str, Any]], status: tuple[str, str]):
    display = display_of(points)
    assert not display.draw(0)
    assert said(display) == [status]


def test_colour_and_opacity_can_be_set():
    display = display_of(TRIANGLE)
    display.set("Color", "#010203")
    display.set("Alpha", 0.5)
    outline = shapes_of(display.draw(0))["outline"]
    assert (outline["colors"], outline["opacity"]) == ([1, 2, 3], 0.5)
