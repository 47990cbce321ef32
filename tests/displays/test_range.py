from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from studio.displays.drawing import Solids
from studio.displays.range import RangeDisplay
from studio.displays.turning import turned
from tests.support.display_messages import STAMP_NS, TYPES, received
from tests.support.drawn import only, said, shapes_of

TYPE = "sensor_msgs/msg/Range"
SONAR = {"field_of_view": math.pi / 2, "min_range": 0.25, "max_range": 4.0, "range": 2.0}


def display_of(fields: dict[str, Any], little: bool = True) -> RangeDisplay:
    display = RangeDisplay(TYPES)
    display.take(received(TYPE, {**SONAR, **fields}, little=little))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_a_range_is_a_cone_with_its_tip_at_the_sensor(little: bool):
    display = display_of({}, little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    half = round(math.sqrt(0.5), 5)
    assert shapes_of(display.draw(0)) == {
        "cone": {
            "shape": "Solids",
            "kind": "cone",
            "positions": [[0.0, 0.0, 0.0]],
            "wxyz": [[half, 0.0, half, 0.0]],
            "scales": [[4.0, 4.0, 2.0]],
            "colors": [255, 255, 255],
            "opacities": 0.5,
        }
    }


def test_the_cone_lies_along_x():
    cone = only(display_of({})).shapes["cone"]
    assert isinstance(cone, Solids)
    base = turned(cone.wxyz.astype(np.float64), np.array([0.0, 0.0, 2.0]))
    np.testing.assert_allclose(base, [[2.0, 0.0, 0.0]], atol=1e-6)


@pytest.mark.parametrize("reading", [0.125, 4.5, math.nan, math.inf, -math.inf])
def test_a_range_beyond_the_limits_shows_nothing_and_says_so(reading: float):
    display = display_of({})
    display.take(received(TYPE, {**SONAR, "range": reading}))
    assert not display.draw(0)
    assert said(display) == [("warn", "out_of_range")]
    assert "0.25 to 4 m" in display.statuses()[0].sentence


@pytest.mark.parametrize(("reading", "seen"), [(-math.inf, True), (math.inf, False)])
def test_a_sensor_of_one_distance_shows_it_when_something_is_near(reading: float, seen: bool):
    display = display_of({"min_range": 1.0, "max_range": 1.0, "range": reading})
    assert bool(display.draw(0)) is seen
    if seen:
        assert shapes_of(display.draw(0))["cone"]["scales"] == [[2.0, 2.0, 1.0]]


@pytest.mark.parametrize("angle", [0.0, -1.0, math.pi, 100.0, math.nan, math.inf])
def test_a_field_of_view_that_makes_no_cone_is_told(angle: float):
    display = display_of({"field_of_view": angle})
    assert not display.draw(0)
    assert said(display) == [("error", "out_of_range")]


@pytest.mark.parametrize("limits", [(0.0, math.inf), (-math.inf, 3e38), (math.nan, math.nan)])
def test_limits_of_any_kind_draw_what_can_be_drawn(limits: tuple[float, float]):
    display = display_of({"min_range": limits[0], "max_range": limits[1], "range": 3e38})
    assert not display.draw(0)
    assert len(display.statuses()) == 1


def test_a_range_of_zero_is_told():
    display = display_of({"min_range": 0.0, "range": 0.0})
    assert not display.draw(0)
    assert "no length" in display.statuses()[0].sentence


def test_as_many_are_seen_as_the_buffer_is_long_and_misses_count():
    display = display_of({})
    display.set("Buffer Length", 3)
    for reading in (1.0, 9.0, 3.0):
        display.take(received(TYPE, {**SONAR, "range": reading}))
    cones = [placed.shapes["cone"] for placed in display.draw(0).values()]
    assert sorted(float(one.scales[0, 2]) for one in cones if isinstance(one, Solids)) == [1.0, 3.0]
