from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from studio.displays.odometry import OdometryDisplay
from tests.support.display_messages import STAMP, STAMP_NS, TYPES, pose, received
from tests.support.drawn import only, said, shapes_of

TYPE = "nav_msgs/msg/Odometry"


def take(
    display: OdometryDisplay,
    what: dict[str, Any],
    diagonal: list[float] | None = None,
    *,
    frame: str = "odom",
    little: bool = True,
) -> None:
    covariance = np.diag(diagonal or [0.0] * 6).reshape(-1).tolist()
    header = {"frame_id": frame, "stamp": STAMP}
    fields = {"header": header, "pose": {"pose": what, "covariance": covariance}}
    display.take(received(TYPE, fields, little=little))


def driven(*places: tuple[float, float], **values: Any) -> OdometryDisplay:  # noqa: ANN401
    """A display that saw a robot at some x, each with a yaw."""
    display = OdometryDisplay(TYPES, {name.replace("_", " "): one for name, one in values.items()})
    for x, yaw in places:
        take(display, pose((x, 0.0, 0.0), (math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))))
    return display


@pytest.mark.parametrize("little", [True, False])
def test_a_pose_is_an_arrow_in_the_frame_of_the_odometry(little: bool):
    display = OdometryDisplay(TYPES)
    take(display, pose((1.0, 2.0, 0.0)), little=little)
    placed = only(display)
    assert (placed.frame, placed.stamp_ns) == ("odom", STAMP_NS)
    assert shapes_of(display.draw(0)) == {
        "arrows": {
            "shape": "Arrows",
            "ends": [[[1.0, 2.0, 0.0], [2.3, 2.0, 0.0]]],
            "colors": [255, 25, 0],
            "shaft_diameter_m": 0.05,
            "head_diameter_m": 0.1,
            "head_length_m": 0.3,
            "opacity": 1.0,
        }
    }


def test_a_pose_is_drawn_with_how_sure_it_is():
    display = OdometryDisplay(TYPES)
    take(display, pose(), [0.01, 0.01, 0.0, 0.0, 0.0, 0.04])
    assert set(shapes_of(display.draw(0))) == {"arrows", "position", "orientation"}


def test_another_pose_is_drawn_when_the_robot_moved_or_turned_far_enough():
    assert len(driven((0.0, 0.0), (0.05, 0.0), (0.09, 0.05)).draw(0)) == 1
    assert len(driven((0.0, 0.0), (0.2, 0.0)).draw(0)) == 2
    assert len(driven((0.0, 0.0), (0.0, 0.2)).draw(0)) == 2


def test_small_moves_add_up():
    assert len(driven(*((0.04 * step, 0.0) for step in range(10))).draw(0)) == 4


def test_tolerances_can_be_set_and_zero_draws_every_pose():
    standing = [(0.0, 0.0)] * 3
    assert len(driven(*standing, Position_Tolerance=0.0).draw(0)) == 3
    assert len(driven(*standing, Angle_Tolerance=0.0).draw(0)) == 3
    assert len(driven((0.0, 0.0), (5.0, 0.0), Position_Tolerance=10.0).draw(0)) == 1


def test_the_same_pose_in_another_frame_is_another():
    display = driven((0.0, 0.0))
    take(display, pose(), frame="map")
    assert {one.frame for one in display.draw(0).values()} == {"odom", "map"}


def test_as_many_are_kept_as_is_said_and_zero_keeps_very_many():
    way = [(float(x), 0.0) for x in range(20)]
    assert len(driven(*way, Keep=5).draw(0)) == 5
    assert len(driven(*way, Keep=0).draw(0)) == 20


def test_poses_can_be_axes():
    display = driven((0.0, 0.0))
    display.set("Shape", "Axes")
    display.set("Shape/Axes Length", 0.5)
    assert shapes_of(display.draw(0))["axes"]["length_m"] == 0.5


@pytest.mark.parametrize(
    "turn", [(0.0, 0.0, 0.0, 0.0), (2.0, 0.0, 0.0, 0.0), (1e308, 0.0, 0.0, 0.0)]
)
def test_a_quaternion_of_another_length_is_refused_as_in_rviz(
    turn: tuple[float, float, float, float],
):
    display = OdometryDisplay(TYPES)
    take(display, pose(wxyz=turn))
    assert not display.draw(0)
    assert said(display) == [("error", "bad_message")]


@pytest.mark.parametrize("number", [math.nan, math.inf, 1e308])
def test_numbers_that_cannot_be_drawn_are_told(number: float):
    display = OdometryDisplay(TYPES)
    take(display, pose((number, 0.0, 0.0)))
    assert not display.draw(0)
    assert said(display) == [("error", "not_finite")]


def test_what_is_no_covariance_is_told():
    display = OdometryDisplay(TYPES)
    take(display, pose(), [-1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    assert said(display) == [("warn", None)]


def test_that_its_length_is_0_is_said_only_where_nothing_else_of_a_pose_is_seen():
    display = driven((1.0, 0.0))
    for part in ("Shaft Length", "Head Length"):
        display.set(f"Shape/{part}", 0.0)
    (status,) = display.statuses()
    assert (status.reason, status.mend) == ("empty", ("Shape/Shaft Length", 1.0))
    take(display, pose((5.0, 0.0, 0.0)), [0.01] * 6)
    assert display.draw(0)
    assert display.statuses() == ()
    display.set("Covariance", value=False)
    assert said(display) == [("warn", "empty")]
