from __future__ import annotations

import math

import pytest

from studio.displays.point import PointStampedDisplay
from tests.support.display_messages import STAMP_NS, TYPES, point, received
from tests.support.drawn import only, said, shapes_of

TYPE = "geometry_msgs/msg/PointStamped"


@pytest.mark.parametrize("little", [True, False])
def test_a_point_is_a_ball(little: bool):
    display = PointStampedDisplay(TYPES)
    display.take(received(TYPE, {"point": point(1.0, 2.0, 3.0)}, little=little))
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    assert shapes_of(display.draw(0)) == {
        "ball": {
            "shape": "Solids",
            "kind": "sphere",
            "positions": [[1.0, 2.0, 3.0]],
            "wxyz": [[1.0, 0.0, 0.0, 0.0]],
            "scales": [[0.2, 0.2, 0.2]],
            "colors": [204, 41, 204],
            "opacities": 1.0,
        }
    }


def test_size_colour_and_opacity_can_be_set():
    display = PointStampedDisplay(TYPES, {"Radius": 1.5, "Color": "#ffffff", "Alpha": 0.1})
    display.take(received(TYPE, {}))
    ball = shapes_of(display.draw(0))["ball"]
    assert (ball["scales"], ball["colors"], ball["opacities"]) == (
        [[1.5, 1.5, 1.5]], [255, 255, 255], 0.1,
    )  # fmt: skip


@pytest.mark.parametrize("number", [math.nan, math.inf, -1e308])
def test_a_point_that_cannot_be_drawn_is_told(number: float):
    display = PointStampedDisplay(TYPES)
    display.take(received(TYPE, {"point": point(0.0, number, 0.0)}))
    assert not display.draw(0)
    assert said(display) == [("error", "not_finite")]
