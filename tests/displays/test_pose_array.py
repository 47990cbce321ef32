from __future__ import annotations

import math
from time import thread_time
from typing import Any

import numpy as np
import pytest

from studio.displays.display import Limits, Received
from studio.displays.drawing import Lines
from studio.displays.pose_array import POSES_MAX, PoseArrayDisplay
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, pose, received
from tests.support.drawn import assert_drawable, only, plain, said, shapes_of

TYPE = "geometry_msgs/msg/PoseArray"
HALF = (0.0, 0.0, 0.0, 1.0)


def display_of(poses: list[dict[str, Any]], little: bool = True) -> PoseArrayDisplay:
    display = PoseArrayDisplay(TYPES)
    display.take(received(TYPE, {"poses": poses}, little=little))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_poses_are_flat_arrows_at_first(little: bool):
    display = display_of([pose((1.0, 0.0, 0.0)), pose((0.0, 2.0, 0.0), HALF)], little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    assert shapes_of(display.draw(0)) == {
        "arrows": {
            "shape": "Lines",
            "ends": [
                [[1.0, 0.0, 0.0], [1.3, 0.0, 0.0]],
                [[1.3, 0.0, 0.0], [1.225, 0.06, 0.0]],
                [[1.3, 0.0, 0.0], [1.225, -0.06, 0.0]],
                [[0.0, 2.0, 0.0], [-0.3, 2.0, 0.0]],
                [[-0.3, 2.0, 0.0], [-0.225, 1.94, 0.0]],
                [[-0.3, 2.0, 0.0], [-0.225, 2.06, 0.0]],
            ],
            "colors": [255, 25, 0],
            "width_m": 0.0,
            "opacity": 1.0,
        }
    }


@pytest.mark.parametrize("little", [True, False])
def test_poses_can_be_solid_arrows(little: bool):
    display = display_of([pose((1.0, 0.0, 0.0)), pose((0.0, 2.0, 0.0), HALF)], little)
    display.set("Shape", "Arrow (3D)")
    assert shapes_of(display.draw(0)) == {
        "arrows": {
            "shape": "Arrows",
            "ends": [[[1.0, 0.0, 0.0], [1.3, 0.0, 0.0]], [[0.0, 2.0, 0.0], [-0.3, 2.0, 0.0]]],
            "colors": [255, 25, 0],
            "shaft_diameter_m": 0.01,
            "head_diameter_m": 0.03,
            "head_length_m": 0.07,
            "opacity": 1.0,
        }
    }


def test_poses_can_be_axes():
    display = display_of([pose((1.0, 0.0, 0.0)), pose((0.0, 2.0, 0.0), HALF)])
    display.set("Shape", "Axes")
    assert shapes_of(display.draw(0)) == {
        "axes": {
            "shape": "Axes",
            "positions": [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
            "wxyz": [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
            "length_m": 0.3,
            "radius_m": 0.005,
            "opacity": 1.0,
        }
    }


def test_the_length_of_flat_arrows_can_be_set():
    display = display_of([pose()])
    display.set("Arrow Length", 1.0)
    assert shapes_of(display.draw(0))["arrows"]["ends"][0] == [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
    display.set("Arrow Length", 0.0)
    assert not display.draw(0)


def test_a_message_without_poses_empties_the_view_and_says_so():
    display = display_of([pose()])
    display.take(received(TYPE, {"poses": []}))
    assert not display.draw(0)
    assert said(display) == [("warn", "empty")]


def test_poses_that_cannot_be_drawn_are_left_out_and_counted():
    display = display_of([pose((math.nan, 0.0, 0.0)), pose((1.0, 0.0, 0.0)), pose((1e308, 0, 0))])
    (status,) = display.statuses()
    assert status.reason == "not_finite"
    assert "2 of 3 poses are left out" in status.sentence
    arrows = only(display).shapes["arrows"]
    assert plain(arrows)["ends"][0] == [[1.0, 0.0, 0.0], [1.3, 0.0, 0.0]]


def test_when_no_pose_can_be_drawn_the_last_ones_stay():
    display = display_of([pose((1.0, 0.0, 0.0))])
    before = display.draw(0)
    display.take(received(TYPE, {"poses": [pose((math.inf, 0.0, 0.0))] * 4}))
    assert display.draw(0) is before
    assert said(display) == [("error", "not_finite")]


def test_quaternions_of_zeros_are_drawn_as_no_turn_and_counted():
    display = display_of([pose(wxyz=(0.0, 0.0, 0.0, 0.0)), pose()])
    assert "1 of 2 poses have a quaternion of zeros" in display.statuses()[0].sentence
    assert_drawable(display.draw(0))


def test_a_million_poses_are_thinned_in_a_moment():
    one = received(TYPE, {"poses": [pose()]}).cdr
    at = bytes(one).rindex((1).to_bytes(4, "little") + bytes(4))
    numbers = np.tile(np.array([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]), (1_000_000, 1))
    numbers[:, 0] = np.arange(1_000_000)
    head = bytes(one)[:at] + (1_000_000).to_bytes(4, "little")
    raw = head + bytes(-(len(head) - 4) % 8) + numbers.tobytes()
    display = PoseArrayDisplay(TYPES)
    before = thread_time()
    display.take(Received(TYPE, raw, NOW_NS))
    arrows = only(display).shapes["arrows"]
    assert thread_time() - before < 10
    assert isinstance(arrows, Lines)
    assert len(arrows.ends) == 3 * POSES_MAX
    assert arrows.ends[0, 0, 0] == 0.0
    assert arrows.ends[-3, 0, 0] == 999_999.0
    assert said(display) == [("ok", "thinned")]
    assert display.statuses()[0].sentence.startswith("Showing 50,000 of 1,000,000 poses")


def test_a_limit_from_outside_is_held():
    display = PoseArrayDisplay(TYPES)
    display.limit(Limits(points=2))
    display.take(received(TYPE, {"poses": [pose((float(x), 0.0, 0.0)) for x in range(5)]}))
    display.set("Shape", "Axes")
    assert plain(only(display).shapes["axes"])["positions"] == [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]]


@pytest.mark.parametrize(
    ("shape", "sizes"),
    [
        ("Arrow (Flat)", ["Arrow Length"]),
        ("Arrow (3D)", ["Shaft Length", "Head Length"]),
        ("Axes", ["Axes Length"]),
    ],
)
def test_poses_of_no_length_are_not_drawn_and_their_display_says_how_they_would_be(
    shape: str, sizes: list[str]
):
    display = display_of([pose()])
    for name, value in (("Shape", shape), *((size, 0.0) for size in sizes)):
        display.set(name, value)
    assert not display.draw(0)
    (status,) = display.statuses()
    assert status.mend is not None
    assert (status.reason, status.mend[0]) == ("empty", sizes[0])
    display.set(*status.mend)
    assert display.draw(0)
    assert display.statuses() == ()
