from __future__ import annotations

import math

import pytest

from studio.displays.vectors import WrenchDisplay
from tests.support.display_messages import TYPES, point, received
from tests.support.drawn import said, shapes_of

TYPE = "geometry_msgs/msg/WrenchStamped"


@pytest.mark.parametrize("little", [True, False])
def test_numbers_that_are_none_count_as_zero_if_wished(little: bool):
    display = WrenchDisplay(TYPES, {"Accept NaN Values": True})
    fields = {"wrench": {"force": point(math.nan, 1.0, math.nan), "torque": point(0, math.nan, 0)}}
    display.take(received(TYPE, fields, little=little))
    assert shapes_of(display.draw(0))["straight"]["ends"][0][1] == [0.0, 2.6, 0.0]
    assert said(display) == []


def test_infinite_numbers_are_refused_even_then():
    display = WrenchDisplay(TYPES, {"Accept NaN Values": True})
    display.take(received(TYPE, {"wrench": {"force": point(math.inf, 0.0, 0.0)}}))
    assert said(display) == [("error", "not_finite")]
