from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.course.turtlesim.turtles import FIELD_M, MIDDLE_M, STEP_S, Turtle, within_a_turn

ANY_FLOAT = st.floats(width=32)


def walk(turtle: Turtle, seconds: float) -> bool:
    was_free = [turtle.step() for _ in range(round(seconds / STEP_S))]
    return all(was_free)


def test_a_command_moves_the_turtle_for_a_second_and_no_longer():
    turtle = Turtle("turtle1")
    turtle.command(2.0, 0.0, 0.0)
    walk(turtle, 5.0)
    assert turtle.x == pytest.approx(MIDDLE_M + 2.0, abs=2 * 2.0 * STEP_S)
    assert turtle.forward_m_s == 0.0


def test_it_turns_and_goes_sideways():
    turtle = Turtle("turtle1")
    turtle.command(0.0, 1.0, 0.0)
    walk(turtle, 0.8)
    assert (turtle.x, turtle.y) == pytest.approx((MIDDLE_M, MIDDLE_M + 0.8))
    turtle.command(0.0, 0.0, -1.0)
    walk(turtle, 0.8)
    assert turtle.theta == pytest.approx(-0.8)


def test_a_wall_holds_it_up_and_says_so():
    turtle = Turtle("turtle1")
    turtle.command(10.0, 0.0, 0.0)
    assert not walk(turtle, 1.0)
    assert (turtle.x, turtle.y) == (FIELD_M, MIDDLE_M)


def test_a_heading_is_reached_exactly_by_the_shorter_way():
    turtle = Turtle("turtle1", theta=3.0)
    turtle.goal_theta = -3.0
    walk(turtle, 0.2)
    assert turtle.turn_rad_s > 0
    assert turtle.remaining_rad == pytest.approx(math.tau - 6.0 - 0.192)
    walk(turtle, 0.2)
    assert (turtle.theta, turtle.goal_theta) == (-3.0, None)
    turtle.step()
    assert turtle.turn_rad_s == 0.0


def test_a_command_ends_a_rotation():
    turtle = Turtle("turtle1")
    turtle.goal_theta = 2.0
    turtle.step()
    turtle.command(1.0, 0.0, 0.0)
    assert turtle.goal_theta is None


def test_teleporting_ahead_turns_first():
    turtle = Turtle("turtle1")
    turtle.teleport_ahead(2.0, math.pi / 2)
    assert (turtle.x, turtle.y, turtle.theta) == pytest.approx(
        (MIDDLE_M, MIDDLE_M + 2.0, math.pi / 2)
    )


@given(ANY_FLOAT, ANY_FLOAT, ANY_FLOAT)
def test_whatever_is_asked_it_stays_on_the_ground(one: float, other: float, third: float):
    turtle = Turtle("turtle1")
    turtle.teleport(one, other, third)
    turtle.teleport_ahead(other, third)
    turtle.command(one, other, third)
    turtle.step()
    assert 0.0 <= turtle.x <= FIELD_M
    assert 0.0 <= turtle.y <= FIELD_M
    assert -math.pi < turtle.theta <= math.pi


@given(st.floats(-1e6, 1e6))
def test_an_angle_within_a_turn_points_the_same_way(angle: float):
    wrapped = within_a_turn(angle)
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)
