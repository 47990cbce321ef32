from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.course.rover.drive import COMMAND_LASTS_S, REACH_M, TRACK_M, WHEEL_RADIUS_M, Drive
from studio.course.rover.room import clearance_m

STEP_S = 0.02


def drive(rover: Drive, forward: float, turn: float, seconds: float) -> None:
    for _ in range(round(seconds / STEP_S)):
        rover.command(forward, turn)
        rover.step(STEP_S)


def test_it_reaches_the_speed_that_is_asked_and_stops_when_nobody_asks():
    rover = Drive()
    drive(rover, 0.5, 0.0, 2.0)
    assert rover.forward_m_s == pytest.approx(0.5)
    for _ in range(round((COMMAND_LASTS_S + 1.0) / STEP_S)):
        rover.step(STEP_S)
    assert rover.forward_m_s == 0.0


def test_a_turn_on_the_spot_turns_the_wheels_against_each_other():
    rover = Drive()
    drive(rover, 0.0, 1.0, 1.0)
    left, right = rover.wheels_rad
    assert left == pytest.approx(-right)
    assert right * WHEEL_RADIUS_M == pytest.approx(rover.yaw * TRACK_M / 2)


def test_it_drives_an_arc():
    rover = Drive()
    drive(rover, 0.4, 0.4, 6.0)
    assert math.hypot(rover.x, rover.y + 2.2 - 1.0) == pytest.approx(1.0, abs=0.08)


def test_no_number_means_stand():
    rover = Drive()
    rover.command(math.nan, 1.0)
    rover.step(STEP_S)
    assert (rover.forward_m_s, rover.turn_rad_s) == (0.0, 0.0)


@given(st.lists(st.tuples(st.floats(-2, 2), st.floats(-3, 3)), max_size=12))
def test_no_command_drives_it_into_a_wall(commands: list[tuple[float, float]]):
    rover = Drive()
    for forward, turn in commands:
        drive(rover, forward, turn, 1.0)
        assert clearance_m(rover.x, rover.y) >= REACH_M - 1e-9


def test_a_wall_holds_it_up_and_says_so_and_it_can_back_away():
    rover = Drive()
    drive(rover, 1.0, 0.0, 8.0)
    rover.command(1.0, 0.0)
    assert not rover.step(STEP_S)
    stuck = rover.x
    drive(rover, -0.5, 0.0, 2.0)
    assert rover.x < stuck - 0.5
