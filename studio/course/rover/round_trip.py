"""RoundTrip: the path around the room that the rover drives when nobody else drives it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

SPEED_M_S = 0.45
_AHEAD_M = 0.55
_STEP_M = 0.1
_CORNERS_M = ((-2.9, -2.2), (2.6, -2.2), (2.6, 2.2), (-2.9, 2.2))
_CORNER_RADIUS_M = 0.9
_QUARTER = math.pi / 2


class RoundTrip:
    """A closed path; `path_m` has shape (N, 2), one point every tenth of a metre."""

    def __init__(self) -> None:
        self.path_m = _rounded(_CORNERS_M, _CORNER_RADIUS_M)

    def plan_from(self, x: float, y: float) -> NDArray[np.float64]:
        """Return the path from the point nearest to the rover once around, shape (N, 2)."""
        return np.roll(self.path_m, -self._nearest(x, y), axis=0)

    def steer(self, x: float, y: float, yaw: float) -> tuple[float, float]:
        """Return speeds, m/s ahead and rad/s to the left, that bring the rover along the path."""
        ahead = (self._nearest(x, y) + round(_AHEAD_M / _STEP_M)) % len(self.path_m)
        goal_x, goal_y = self.path_m[ahead] - (x, y)
        bearing = math.remainder(math.atan2(goal_y, goal_x) - yaw, math.tau)
        if abs(bearing) > _QUARTER:
            return 0.0, math.copysign(1.0, bearing)
        distance = max(math.hypot(goal_x, goal_y), _AHEAD_M)
        speed = SPEED_M_S * math.cos(bearing)
        return speed, 2 * SPEED_M_S * math.sin(bearing) / distance

    def _nearest(self, x: float, y: float) -> int:
        return int(np.hypot(*(self.path_m - (x, y)).T).argmin())


def _rounded(corners: tuple[tuple[float, float], ...], radius: float) -> NDArray[np.float64]:
    """Join corners, given against the clock and square to each other, by lines and arcs."""
    places: list[NDArray[np.float64]] = []
    count = len(corners)
    for number in range(count):
        before, corner, after = (np.array(corners[(number + k) % count]) for k in (-1, 0, 1))
        into = (corner - before) / np.linalg.norm(corner - before)
        out = (after - corner) / np.linalg.norm(after - corner)
        middle = corner - into * radius + out * radius
        turned = np.linspace(0.0, _QUARTER, round(_QUARTER * radius / _STEP_M), endpoint=False)
        arc = middle + radius * (np.outer(np.sin(turned), into) - np.outer(np.cos(turned), out))
        start, end = corner + out * radius, after - out * radius
        steps = round(float(np.linalg.norm(end - start)) / _STEP_M)
        line = start + np.linspace(0.0, 1.0, steps, endpoint=False)[:, None] * (end - start)
        places += [arc, line]
    return np.concatenate(places)
