"""Drive: four wheels, two sides, one pose; commands wear off and walls stop it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from studio.course.rover.room import clearance_m

WHEEL_RADIUS_M = 0.105
TRACK_M = 0.492
"""Left wheels to right wheels, middle to middle."""
REACH_M = 0.38
"""The nearest that its middle comes to a wall."""
COMMAND_LASTS_S = 0.5
SPEED_MAX_M_S, TURN_MAX_RAD_S = 1.0, 2.0
_ACCELERATION_M_S2, _TURN_RAD_S2 = 1.5, 4.0


@dataclass(slots=True)
class Drive:
    """Pose in the frame odom, metres and radians, with the speeds it has right now."""

    x: float = 0.0
    y: float = -2.2
    yaw: float = 0.0
    forward_m_s: float = 0.0
    turn_rad_s: float = 0.0
    acceleration_m_s2: float = 0.0
    wheels_rad: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """Angles of the left and the right wheels."""
    _wanted: tuple[float, float] = (0.0, 0.0)
    _wanted_for_s: float = 0.0

    def command(self, forward_m_s: float, turn_rad_s: float) -> None:
        """Take a velocity, within the motors' limits; one that is no number means to stop."""
        if not (math.isfinite(forward_m_s) and math.isfinite(turn_rad_s)):
            forward_m_s = turn_rad_s = 0.0
        self._wanted = (
            _within(forward_m_s, SPEED_MAX_M_S),
            _within(turn_rad_s, TURN_MAX_RAD_S),
        )
        self._wanted_for_s = COMMAND_LASTS_S

    def step(self, step_s: float) -> bool:
        """Drive on; False when a wall held it up."""
        forward, turn = self._wanted if self._wanted_for_s > 0 else (0.0, 0.0)
        self._wanted_for_s -= step_s
        before = self.forward_m_s
        self.forward_m_s += _within(forward - before, _ACCELERATION_M_S2 * step_s)
        self.turn_rad_s += _within(turn - self.turn_rad_s, _TURN_RAD_S2 * step_s)
        is_free = self._roll(step_s)
        self.acceleration_m_s2 = (self.forward_m_s - before) / step_s
        return is_free

    def _roll(self, step_s: float) -> bool:
        """Follow the arc of this step, unless it leads nearer to a wall than it may."""
        middle_yaw = self.yaw + self.turn_rad_s * step_s / 2
        x = self.x + math.cos(middle_yaw) * self.forward_m_s * step_s
        y = self.y + math.sin(middle_yaw) * self.forward_m_s * step_s
        room = clearance_m(x, y)
        is_free = room >= REACH_M or room >= clearance_m(self.x, self.y)
        if is_free:
            self.x, self.y = x, y
        else:
            self.forward_m_s = 0.0
        self.yaw = math.remainder(self.yaw + self.turn_rad_s * step_s, math.tau)
        for side, sign in enumerate((-1, 1)):
            speed = self.forward_m_s + sign * self.turn_rad_s * TRACK_M / 2
            self.wheels_rad[side] += speed / WHEEL_RADIUS_M * step_s
        return is_free


def _within(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)
