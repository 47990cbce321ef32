"""The turtles of turtlesim without ROS: where each is, how it walks, and what they have drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

FIELD_M = 11.088889
"""Width and height of the ground: 500 pixels of 45 to the metre, the last one left out."""
MIDDLE_M = FIELD_M / 2
STEP_S = 0.016
COMMAND_LASTS_S = 1.0
ROTATION_RAD_S = 1.0


@dataclass(slots=True)
class Pen:
    """A turtle's pen; `width_px` in pixels."""

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
        """The angle left to the goal's heading; 0 without one."""
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


SIZE_PX = 500
_PIXELS_BY_M = (SIZE_PX - 1) / FIELD_M


class Paper:
    """Square of `SIZE_PX` pixels; undrawn ones show the background."""

    def __init__(self) -> None:
        self._colors = np.zeros((SIZE_PX, SIZE_PX, 3), dtype=np.uint8)
        self._drawn = np.zeros((SIZE_PX, SIZE_PX), dtype=np.bool_)

    def clear(self) -> None:
        """Wipe all lines."""
        self._drawn[:] = False

    def draw(self, start: tuple[float, float], end: tuple[float, float], pen: Pen) -> None:
        """Draw a straight line between two places, in metres, with round ends."""
        if not pen.is_down or pen.width_px <= 0:
            return
        first, last = _pixel(start), _pixel(end)
        steps = max(1, math.ceil(math.dist(first, last)))
        for column, row in np.linspace(first, last, steps + 1):
            self._dot(round(float(column)), round(float(row)), pen)

    def color_at(self, x: float, y: float) -> tuple[int, int, int] | None:
        """Return the colour that was drawn at a place in metres; None for the background."""
        column, row = (round(value) for value in _pixel((x, y)))
        if not self._drawn[row, column]:
            return None
        red, green, blue = self._colors[row, column].tolist()
        return red, green, blue

    def picture(self, background: tuple[int, int, int]) -> np.ndarray:
        """Return the ground, shape (SIZE_PX, SIZE_PX, 3), uint8, top row first."""
        return np.where(self._drawn[..., None], self._colors, np.array(background, dtype=np.uint8))

    def _dot(self, column: int, row: int, pen: Pen) -> None:
        low, high = (pen.width_px - 1) // 2, pen.width_px // 2
        rows = slice(max(row - low, 0), row + high + 1)
        columns = slice(max(column - low, 0), column + high + 1)
        self._colors[rows, columns] = pen.color
        self._drawn[rows, columns] = True


def _pixel(place: tuple[float, float]) -> tuple[float, float]:
    """Column and row of a place in metres: y points up, rows go down."""
    return place[0] * _PIXELS_BY_M, (FIELD_M - place[1]) * _PIXELS_BY_M


TURTLES_MAX = 100


class Flock:
    """All turtles of one ground."""

    def __init__(self) -> None:
        self.paper = Paper()
        self.turtles: dict[str, Turtle] = {}
        self._count = 0

    def spawn(self, x: float, y: float, theta: float, name: str = "") -> Turtle | None:
        """Put one more turtle on the ground; None where its name is taken or the ground is full."""
        if not name:
            name = self._next_name()
        if name in self.turtles or len(self.turtles) >= TURTLES_MAX:
            return None
        turtle = self.turtles[name] = Turtle(name)
        turtle.teleport(x, y, theta)
        return turtle

    def step(self, step_s: float = STEP_S) -> list[Turtle]:
        """Let all walk one step, drawing; gives those that ran into a wall."""
        stopped: list[Turtle] = []
        for turtle in self.turtles.values():
            start = (turtle.x, turtle.y)
            if not turtle.step(step_s):
                stopped.append(turtle)
            if start != (turtle.x, turtle.y):
                self.paper.draw(start, (turtle.x, turtle.y), turtle.pen)
        return stopped

    def color_below(self, turtle: Turtle, background: tuple[int, int, int]) -> tuple[int, int, int]:
        """Return the colour of the ground where a turtle is."""
        return self.paper.color_at(turtle.x, turtle.y) or background

    def clear(self) -> None:
        """Take all turtles away and wipe the paper; counting begins again."""
        self.turtles.clear()
        self.paper.clear()
        self._count = 0

    def _next_name(self) -> str:
        self._count += 1
        while f"turtle{self._count}" in self.turtles:
            self._count += 1
        return f"turtle{self._count}"
