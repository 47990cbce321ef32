"""Turtle: where one is, how it walks, and what it draws with."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

FIELD_M = 11.088889
"""Width and height of the ground: 500 pixels of 45 to the metre, the last one left out."""
MIDDLE_M = FIELD_M / 2
STEP_S = 0.016
COMMAND_LASTS_S = 1.0
ROTATION_RAD_S = 1.0


@dataclass(slots=True)
class Pen:
    """What a turtle draws with; `width_px` in pixels."""

    color: tuple[int, int, int] = (179, 184, 255)
    width_px: int = 3
    is_down: bool = True


@dataclass(slots=True)
class Turtle:
    """One turtle; metres and radians, x to the right and y upwards from the lower left corner."""

    name: str
    x: float = MIDDLE_M
    y: float = MIDDLE_M
    theta: float = 0.0
    pen: Pen = field(default_factory=Pen)
    forward_m_s: float = 0.0
    left_m_s: float = 0.0
    turn_rad_s: float = 0.0
    command_left_s: float = 0.0
    goal_theta: float | None = None

    def command(self, forward_m_s: float, left_m_s: float, turn_rad_s: float) -> None:
        """Walk so for a second; what turned it to a heading ends."""
        speeds = (forward_m_s, left_m_s, turn_rad_s)
        if all(math.isfinite(speed) for speed in speeds):
            self.forward_m_s, self.left_m_s, self.turn_rad_s = speeds
            self.command_left_s, self.goal_theta = COMMAND_LASTS_S, None

    def step(self, step_s: float = STEP_S) -> bool:
        """Walk on for one step; False when a wall held it up."""
        if self.goal_theta is not None:
            self._rotate(self.goal_theta, step_s)
        elif self.command_left_s <= 0.0:
            self.forward_m_s = self.left_m_s = self.turn_rad_s = 0.0
        self.command_left_s -= step_s
        self.theta = within_a_turn(self.theta + self.turn_rad_s * step_s)
        return self._move(self.forward_m_s * step_s, self.left_m_s * step_s)

    def teleport(self, x: float, y: float, theta: float) -> None:
        """Set it to a place; one that is off the ground, or no number, is the nearest edge."""
        self.x, self.y = _on_the_ground(x), _on_the_ground(y)
        self.theta = within_a_turn(theta)

    def teleport_ahead(self, forward_m: float, turn_rad: float) -> None:
        """Turn, then go straight."""
        self.theta = within_a_turn(self.theta + turn_rad)
        if math.isfinite(forward_m):
            self._move(forward_m, 0.0)

    @property
    def remaining_rad(self) -> float:
        """How far it has yet to turn to the heading that was asked for; 0 without one."""
        return 0.0 if self.goal_theta is None else within_a_turn(self.goal_theta - self.theta)

    def _rotate(self, goal_theta: float, step_s: float) -> None:
        """Turn towards the heading; the last step ends on it exactly, and the goal with it."""
        self.forward_m_s = self.left_m_s = 0.0
        remaining = within_a_turn(goal_theta - self.theta)
        if abs(remaining) <= ROTATION_RAD_S * step_s:
            self.theta, self.turn_rad_s, self.goal_theta = within_a_turn(goal_theta), 0.0, None
        else:
            self.turn_rad_s = math.copysign(ROTATION_RAD_S, remaining)

    def _move(self, forward_m: float, left_m: float) -> bool:
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        x = self.x + cosine * forward_m - sine * left_m
        y = self.y + sine * forward_m + cosine * left_m
        self.x, self.y = _on_the_ground(x), _on_the_ground(y)
        return (self.x, self.y) == (x, y)


def within_a_turn(angle_rad: float) -> float:
    """Bring an angle to (-pi, pi]; one that is no number is 0."""
    if not math.isfinite(angle_rad):
        return 0.0
    wrapped = math.remainder(angle_rad, math.tau)
    return math.pi if wrapped == -math.pi else wrapped


def _on_the_ground(place_m: float) -> float:
    return 0.0 if math.isnan(place_m) else min(max(place_m, 0.0), FIELD_M)
