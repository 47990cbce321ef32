from __future__ import annotations

import math
from typing import Any

import pytest

from studio.displays.imu import ImuDisplay
from tests.support.display_messages import STAMP_NS, TYPES, point, received
from tests.support.drawn import only, said, shapes_of

TYPE = "sensor_msgs/msg/Imu"
HALF = math.sqrt(0.5)
QUARTER_ABOUT_Z = {"w": HALF, "x": 0.0, "y": 0.0, "z": HALF}
ACCELERATION, RATE = "Acceleration properties", "Angular velocity properties"
AXES_ON = "Axes properties/Enable axes"
MESSAGE: dict[str, Any] = {
    "orientation": QUARTER_ABOUT_Z,
    "angular_velocity": point(0.0, 0.0, 2.0),
    "linear_acceleration": point(4.0, 0.0, 0.0),
}


def display_of(fields: dict[str, Any], little: bool = True, **values: Any) -> ImuDisplay:  # noqa: ANN401
    display = ImuDisplay(TYPES, values)
    display.take(received(TYPE, {**MESSAGE, **fields}, little=little))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_an_attitude_is_axes_in_the_axes_of_the_fixed_frame(little: bool):
    display = display_of({}, little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns, placed.turns) == ("map", STAMP_NS, False)
    assert shapes_of(display.draw(0)) == {
        "axes": {
            "shape": "Axes",
            "positions": [[0.0, 0.0, 0.0]],
            "wxyz": [[0.70711, 0.0, 0.0, 0.70711]],
            "length_m": 1.0,
            "radius_m": 0.05,
            "opacity": 1.0,
        }
    }


def test_an_attitude_can_be_drawn_in_the_axes_of_its_frame():
    assert only(display_of({}, fixed_frame_orientation=False)).turns


def test_an_attitude_can_be_a_box():
    display = display_of(
        {}, **{"Box properties/Enable box": True, "Axes properties/Enable axes": False}
    )
    display.set("Box properties/x_scale", 2.0)
    assert shapes_of(display.draw(0)) == {
        "box": {
            "shape": "Solids",
            "kind": "box",
            "positions": [[0.0, 0.0, 0.0]],
            "wxyz": [[0.70711, 0.0, 0.0, 0.70711]],
            "scales": [[2.0, 1.0, 1.0]],
            "colors": [255, 0, 0],
            "opacities": 1.0,
        }
    }


@pytest.mark.parametrize(("derotated", "tip"), [(True, [0.0, 5.0, 0.0]), (False, [5.0, 0.0, 0.0])])
def test_an_acceleration_is_an_arrow_turned_with_the_attitude_if_wished(
    derotated: bool, tip: list[float]
):
    display = display_of({}, **{f"{ACCELERATION}/Enable acceleration": True})
    display.set(f"{ACCELERATION}/Derotate acceleration", derotated)
    assert shapes_of(display.draw(0))["acceleration"] == {
        "shape": "Arrows",
        "ends": [[[0.0, 0.0, 0.0], tip]],
        "colors": [255, 0, 0],
        "shaft_diameter_m": 0.5,
        "head_diameter_m": 1.0,
        "head_length_m": 1.0,
        "opacity": 1.0,
    }


def test_an_arrow_has_a_scale():
    display = display_of({}, **{f"{ACCELERATION}/Enable acceleration": True})
    display.set(f"{ACCELERATION}/Acc. vector scale", 0.1)
    arrow = shapes_of(display.draw(0))["acceleration"]
    assert arrow["ends"][0][1] == [0.0, 0.5, 0.0]
    assert arrow["head_length_m"] == 0.1
    display.set(f"{ACCELERATION}/Acc. vector scale", 0.0)
    assert "acceleration" not in shapes_of(display.draw(0))


def test_a_turning_rate_is_an_arrow_about_which_it_turns():
    display = display_of({}, **{f"{RATE}/Enable angular velocity": True})
    assert shapes_of(display.draw(0))["angular velocity"]["ends"] == [
        [[0.0, 0.0, 0.0], [0.0, 0.0, 3.0]]
    ]


def test_what_is_zero_has_no_arrow():
    display = display_of(
        {"linear_acceleration": point(0.0, 0.0, 0.0)},
        **{f"{ACCELERATION}/Enable acceleration": True},
    )
    assert set(shapes_of(display.draw(0))) == {"axes"}


def test_a_unit_that_measures_no_attitude_is_drawn_as_no_turn_and_told():
    display = display_of({"orientation_covariance": [-1.0] + [0.0] * 8})
    assert shapes_of(display.draw(0))["axes"]["wxyz"] == [[1.0, 0.0, 0.0, 0.0]]
    assert "measures no orientation" in display.statuses()[0].sentence


def test_a_quaternion_of_zeros_is_drawn_as_no_turn_and_told():
    display = display_of({"orientation": {"w": 0.0, "x": 0.0, "y": 0.0, "z": 0.0}})
    assert shapes_of(display.draw(0))["axes"]["wxyz"] == [[1.0, 0.0, 0.0, 0.0]]
    assert said(display) == [("warn", None)]


@pytest.mark.parametrize("number", [math.nan, math.inf])
@pytest.mark.parametrize("part", ["orientation", "angular_velocity", "linear_acceleration"])
def test_numbers_that_cannot_be_drawn_are_told(part: str, number: float):
    display = display_of({part: {"x": number}})
    assert not display.draw(0)
    assert said(display) == [("error", "not_finite")]


def test_a_unit_without_any_part_says_what_would_show_it():
    display = display_of({}, **{AXES_ON: False})
    assert not display.draw(0)
    (status,) = display.statuses()
    assert (status.level, status.reason, status.mend) == ("warn", "empty", (AXES_ON, True))
    display.set(f"{RATE}/Enable angular velocity", value=True)
    assert display.draw(0)
    assert display.statuses() == ()


@pytest.mark.parametrize(
    ("switched_on", "sizes"),
    [
        (AXES_ON, ["Axes properties/Axes scale"]),
        ("Box properties/Enable box", [f"Box properties/{axis}_scale" for axis in "xyz"]),
        (f"{ACCELERATION}/Enable acceleration", [f"{ACCELERATION}/Acc. vector scale"]),
        (f"{RATE}/Enable angular velocity", [f"{RATE}/Vector scale"]),
    ],
)
def test_a_part_of_no_size_is_not_seen_and_it_is_said_how_it_would_be(
    switched_on: str, sizes: list[str]
):
    values: dict[str, Any] = {AXES_ON: False, switched_on: True, **dict.fromkeys(sizes, 0.0)}
    display = display_of({}, **values)
    assert not display.draw(0)
    (status,) = display.statuses()
    assert (status.reason, status.mend) == ("empty", (sizes[0], 1.0))
    display.set(sizes[0], 1.0)
    assert display.draw(0)
    assert display.statuses() == ()
