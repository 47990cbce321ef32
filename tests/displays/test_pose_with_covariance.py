from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from studio.displays.pose_with_covariance import PoseWithCovarianceDisplay
from tests.support.display_messages import STAMP_NS, TYPES, pose, received
from tests.support.drawn import only, said, shapes_of

TYPE = "geometry_msgs/msg/PoseWithCovarianceStamped"
DIAGONAL = [0.04, 0.09, 0.16, 0.01, 0.01, 0.01]


def display_of(
    what: dict[str, Any], diagonal: list[float], little: bool = True
) -> PoseWithCovarianceDisplay:
    display = PoseWithCovarianceDisplay(TYPES)
    fields = {"pose": {"pose": what, "covariance": np.diag(diagonal).reshape(-1).tolist()}}
    display.take(received(TYPE, fields, little=little))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_a_pose_is_drawn_with_how_sure_it_is(little: bool):
    display = display_of(pose((1.0, 2.0, 3.0)), DIAGONAL, little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    shapes = shapes_of(display.draw(0))
    assert set(shapes) == {"arrows", "position", "orientation"}
    assert shapes["arrows"]["ends"] == [[[1.0, 2.0, 3.0], [2.3, 2.0, 3.0]]]
    assert shapes["position"] == {
        "shape": "Solids",
        "kind": "sphere",
        "positions": [[1.0, 2.0, 3.0]],
        "wxyz": [[1.0, 0.0, 0.0, 0.0]],
        "scales": [[0.4, 0.6, 0.8]],
        "colors": [204, 51, 204],
        "opacities": 0.3,
    }
    assert shapes["orientation"]["kind"] == "cylinder"
    assert shapes["orientation"]["positions"] == [[2.0, 2.0, 3.0], [1.0, 3.0, 3.0], [1.0, 2.0, 4.0]]


def test_the_pose_can_be_axes():
    display = display_of(pose(), DIAGONAL)
    display.set("Shape", "Axes")
    assert set(shapes_of(display.draw(0))) == {"axes", "position", "orientation"}


def test_the_covariance_can_be_switched_off():
    display = display_of(pose(), DIAGONAL)
    display.set("Covariance", False)
    assert set(shapes_of(display.draw(0))) == {"arrows"}


def test_what_is_no_covariance_is_told_and_the_pose_is_drawn():
    display = display_of(pose(), [-1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    assert said(display) == [("warn", None)]
    assert set(shapes_of(display.draw(0))) == {"arrows", "orientation"}


def test_a_quaternion_of_zeros_is_told():
    display = display_of(pose(wxyz=(0.0, 0.0, 0.0, 0.0)), DIAGONAL)
    assert said(display) == [("warn", None)]


@pytest.mark.parametrize("number", [math.nan, math.inf, 1e308])
def test_numbers_that_cannot_be_drawn_are_told(number: float):
    for display in (
        display_of(pose((number, 0.0, 0.0)), DIAGONAL),
        display_of(pose(), [number, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ):
        assert not display.draw(0)
        assert said(display) == [("error", "not_finite")]


def test_a_part_that_is_transparent_is_told_unless_it_is_switched_off():
    display = display_of(pose(), DIAGONAL)
    display.set("Covariance/Position/Alpha", 0.0)
    (status,) = display.statuses()
    assert status.mend == ("Covariance/Position/Alpha", 0.3)
    display.set("Covariance", False)
    assert display.statuses() == ()
