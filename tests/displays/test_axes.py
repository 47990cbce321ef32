from __future__ import annotations

import pytest

from studio.displays.axes import AxesDisplay
from studio.errors import DisplayPropertyError
from tests.support.display_messages import TYPES
from tests.support.drawn import assert_drawable, only, said, shapes_of


def test_a_cross_stands_at_the_fixed_frame():
    display = AxesDisplay(TYPES)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns, placed.follows) == ("<Fixed Frame>", 0, True)
    assert_drawable(display.draw(0))
    assert shapes_of(display.draw(0)) == {
        "axes": {
            "shape": "Axes",
            "positions": [[0.0, 0.0, 0.0]],
            "wxyz": [[1.0, 0.0, 0.0, 0.0]],
            "length_m": 1.0,
            "radius_m": 0.05,
            "opacity": 1.0,
        }
    }


def test_frame_length_radius_and_opacity_can_be_set():
    display = AxesDisplay(TYPES, {"Reference Frame": "base", "Length": 0.5})
    display.set("Radius", 0.0)
    display.set("Alpha", 0.25)
    assert only(display).frame == "base"
    axes = shapes_of(display.draw(0))["axes"]
    assert (axes["length_m"], axes["radius_m"], axes["opacity"]) == (0.5, 0.00005, 0.25)
    with pytest.raises(DisplayPropertyError):
        display.set("Length", "long")


def test_the_same_cross_is_the_same_object():
    display = AxesDisplay(TYPES)
    first = display.draw(0)
    assert display.draw(1) is first
    display.set("Length", 2.0)
    assert display.draw(2) is not first


def test_what_cannot_be_seen_is_told():
    display = AxesDisplay(TYPES, {"Alpha": 0.0})
    assert display.draw(0) == {}
    assert said(display) == [("warn", "transparent")]
    display.set("Alpha", 1.0)
    assert said(display) == []
