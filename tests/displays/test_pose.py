from __future__ import annotations

import math
from typing import Any

import pytest

from studio.displays.display import Status
from studio.displays.pose import PoseDisplay
from tests.support.display_messages import STAMP_NS, TYPES, pose, received
from tests.support.drawn import only, said, shapes_of

TYPE = "geometry_msgs/msg/PoseStamped"
QUARTER_ABOUT_Z = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))


def display_of(what: dict[str, Any], little: bool = True, **values: Any) -> PoseDisplay:  # noqa: ANN401
    display = PoseDisplay(TYPES, {name.replace("_", " "): one for name, one in values.items()})
    display.take(received(TYPE, {"pose": what}, little=little))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_a_pose_is_an_arrow_along_its_x(little: bool):
    display = display_of(pose((1.0, 2.0, 3.0), QUARTER_ABOUT_Z), little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns, placed.follows, placed.turns) == (
        "map", STAMP_NS, False, True,
    )  # fmt: skip
    assert shapes_of(display.draw(0)) == {
        "arrows": {
            "shape": "Arrows",
            "ends": [[[1.0, 2.0, 3.0], [1.0, 3.3, 3.0]]],
            "colors": [255, 25, 0],
            "shaft_diameter_m": 0.05,
            "head_diameter_m": 0.1,
            "head_length_m": 0.3,
            "opacity": 1.0,
        }
    }


@pytest.mark.parametrize("little", [True, False])
def test_a_pose_can_be_axes(little: bool):
    display = display_of(pose((1.0, 2.0, 3.0), (0.0, 2.0, 0.0, 0.0)), little, Shape="Axes")
    assert shapes_of(display.draw(0)) == {
        "axes": {
            "shape": "Axes",
            "positions": [[1.0, 2.0, 3.0]],
            "wxyz": [[0.0, 1.0, 0.0, 0.0]],
            "length_m": 1.0,
            "radius_m": 0.05,
            "opacity": 1.0,
        }
    }


@pytest.mark.parametrize(
    ("name", "value", "field", "seen"),
    [
        ("Color", "#0000ff", "colors", [0, 0, 255]),
        ("Alpha", 0.25, "opacity", 0.25),
        ("Shaft Length", 2.0, "ends", [[[0.0, 0.0, 0.0], [2.3, 0.0, 0.0]]]),
        ("Shaft Radius", 0.2, "shaft_diameter_m", 0.2),
        ("Head Length", 0.5, "head_length_m", 0.5),
        ("Head Radius", 0.4, "head_diameter_m", 0.4),
    ],
)
def test_each_property_of_an_arrow_changes_it(
    name: str, value: float | str, field: str, seen: object
):
    display = display_of(pose())
    display.set(name, value)
    assert shapes_of(display.draw(0))["arrows"][field] == seen


@pytest.mark.parametrize(
    ("name", "field", "seen"), [("Axes Length", "length_m", 2.0), ("Axes Radius", "radius_m", 1.0)]
)
def test_each_property_of_axes_changes_them(name: str, field: str, seen: float):
    display = display_of(pose(), Shape="Axes")
    display.set(name, 2.0)
    assert shapes_of(display.draw(0))["axes"][field] == seen


def test_only_the_newest_pose_is_seen():
    display = display_of(pose((1.0, 0.0, 0.0)))
    first = display.draw(0)
    display.take(received(TYPE, {"pose": pose((5.0, 0.0, 0.0))}))
    assert list(display.draw(0)) == list(first)
    assert shapes_of(display.draw(0))["arrows"]["ends"][0][0] == [5.0, 0.0, 0.0]


def test_a_quaternion_of_zeros_is_drawn_as_no_turn_and_told():
    display = display_of(pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)))
    assert shapes_of(display.draw(0))["arrows"]["ends"] == [[[0.0, 0.0, 0.0], [1.3, 0.0, 0.0]]]
    assert said(display) == [("warn", None)]


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf, 1e308])
@pytest.mark.parametrize("where", range(7))
def test_numbers_that_cannot_be_drawn_are_told(number: float, where: int):
    parts = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    parts[where] = number
    x, y, z, *turn = parts
    w, i, j, k = turn
    display = display_of(pose((x, y, z), (w, i, j, k)))
    if number == 1e308 and where >= 3:
        # A direction may be of any length.
        assert display.draw(0)
        return
    assert not display.draw(0)
    assert said(display) == [("error", "not_finite")]


@pytest.mark.parametrize(
    ("values", "words", "mend"),
    [
        (
            {"Shaft_Length": 0.0, "Head_Length": 0.0},
            "Shaft Length and Head Length are 0, so nothing of it is seen: raise Shaft Length.",
            ("Shaft Length", 1.0),
        ),
        (
            {"Shape": "Axes", "Axes_Length": 0.0},
            "Axes Length is 0, so nothing of it is seen: raise Axes Length.",
            ("Axes Length", 1.0),
        ),
    ],
)
def test_a_pose_of_no_length_is_not_drawn_and_its_display_says_how_it_would_be(
    values: dict[str, Any], words: str, mend: tuple[str, float]
):
    display = display_of(pose(), **values)
    assert not display.draw(0)
    assert display.statuses() == (Status("warn", "empty", words, mend),)
    display.set(*mend)
    assert display.draw(0)
    assert display.statuses() == ()
