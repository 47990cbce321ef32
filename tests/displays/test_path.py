from __future__ import annotations

import math
from time import thread_time
from typing import Any

import pytest

from studio.displays.display import Limits
from studio.displays.drawing import Lines
from studio.displays.path import POSES_MAX, PathDisplay
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, pose, received
from tests.support.drawn import only, plain, said, shapes_of

TYPE = "nav_msgs/msg/Path"
CORNER = [pose((0.0, 0.0, 0.0)), pose((1.0, 0.0, 0.0)), pose((1.0, 2.0, 0.5))]


def display_of(poses: list[dict[str, Any]], little: bool = True) -> PathDisplay:
    display = PathDisplay(TYPES)
    take(display, poses, little)
    return display


def take(display: PathDisplay, poses: list[dict[str, Any]], little: bool = True) -> None:
    stamped = [{"header": {"frame_id": "ignored"}, "pose": one} for one in poses]
    display.take(received(TYPE, {"poses": stamped}, little=little))


@pytest.mark.parametrize("little", [True, False])
def test_a_path_is_a_hair_line_in_the_frame_of_the_path(little: bool):
    display = display_of(CORNER, little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    assert shapes_of(display.draw(0)) == {
        "line": {
            "shape": "Lines",
            "ends": [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 2.0, 0.5]]],
            "colors": [25, 255, 0],
            "width_m": 0.0,
            "opacity": 1.0,
        }
    }


def test_billboards_have_a_width():
    display = display_of(CORNER)
    display.set("Line Width", 0.5)
    assert shapes_of(display.draw(0))["line"]["width_m"] == 0.0
    display.set("Line Style", "Billboards")
    assert shapes_of(display.draw(0))["line"]["width_m"] == 0.5


def test_an_offset_moves_line_and_poses():
    display = display_of(CORNER[:2])
    display.set("Pose Style", "Axes")
    display.set("Offset/Y", 2.0)
    display.set("Offset/Z", -1.0)
    shapes = shapes_of(display.draw(0))
    assert shapes["line"]["ends"] == [[[0.0, 2.0, -1.0], [1.0, 2.0, -1.0]]]
    assert shapes["axes"]["positions"] == [[0.0, 2.0, -1.0], [1.0, 2.0, -1.0]]


def test_poses_can_be_axes_or_arrows():
    display = display_of(CORNER[:2])
    display.set("Pose Style", "Axes")
    axes = shapes_of(display.draw(0))["axes"]
    assert (axes["length_m"], axes["radius_m"]) == (0.3, 0.015)
    display.set("Pose Style", "Arrows")
    assert shapes_of(display.draw(0))["arrows"] == {
        "shape": "Arrows",
        "ends": [[[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]], [[1.0, 0.0, 0.0], [1.3, 0.0, 0.0]]],
        "colors": [255, 85, 255],
        "shaft_diameter_m": 0.1,
        "head_diameter_m": 0.3,
        "head_length_m": 0.2,
        "opacity": 1.0,
    }


def test_as_many_paths_are_seen_as_the_buffer_is_long():
    display = display_of(CORNER)
    display.set("Buffer Length", 2)
    take(display, CORNER[:2])
    take(display, CORNER[:2])
    assert len(display.draw(0)) == 2


def test_paths_together_hold_no_more_poses_than_the_limit_and_the_newest_stays():
    display = PathDisplay(TYPES, {"Buffer Length": 10})
    display.limit(Limits(points=7))
    for _ in range(3):
        take(display, CORNER)
    assert len(display.draw(0)) == 2
    assert "Showing the newest 2 messages" in display.statuses()[0].sentence
    take(display, CORNER * 2)
    assert len(display.draw(0)) == 1
    take(display, CORNER[:1])
    assert len(display.draw(0)) == 1
    assert said(display) == [("warn", "empty")]


def test_a_line_is_cut_where_a_pose_cannot_be_drawn():
    broken = [*CORNER[:2], pose((math.nan, 0.0, 0.0)), *CORNER[1:]]
    display = display_of(broken)
    assert shapes_of(display.draw(0))["line"]["ends"] == [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.0], [1.0, 2.0, 0.5]],
    ]
    assert said(display) == [("warn", "not_finite")]


@pytest.mark.parametrize(
    ("poses", "status"),
    [
        ([], ("warn", "empty")),
        (CORNER[:1], ("warn", "empty")),
        ([pose((math.inf, 0.0, 0.0))] * 3, ("error", "not_finite")),
    ],
)
def test_why_nothing_is_seen_is_told(poses: list[dict[str, Any]], status: tuple[str, str]):
    display = display_of(poses)
    assert not display.draw(0)
    assert said(display) == [status]


def test_an_empty_path_takes_the_last_one_away_as_planners_do_at_the_goal():
    display = display_of(CORNER)
    take(display, [])
    assert not display.draw(0)


def test_a_million_poses_are_thinned_in_a_moment_and_keep_both_ends():
    three = bytes(received(TYPE, {"poses": [{"pose": one} for one in CORNER]}).cdr)
    step = 72
    at = three.index(b"\3\0\0\0", 12)
    raw = three[:at] + (1_000_000).to_bytes(4, "little") + three[at + 4 : -step]
    raw += three[-2 * step : -step] * 999_997 + three[-step:]
    display = PathDisplay(TYPES)
    before = thread_time()
    display.take(received(TYPE, {})._replace(cdr=raw, received_ns=NOW_NS))
    line = only(display).shapes["line"]
    assert thread_time() - before < 10
    assert isinstance(line, Lines)
    assert len(line.ends) == POSES_MAX - 1
    assert plain(line)["ends"][-1][1] == [1.0, 2.0, 0.5]
    assert said(display) == [("ok", "thinned")]
