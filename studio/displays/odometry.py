"""OdometryDisplay: where a robot was, step by step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from studio.displays.display import TopicRole
from studio.displays.history import KEPT_MAX
from studio.displays.pose_with_covariance import COVARIANCE_PROPERTIES as COVARIANCE
from studio.displays.pose_with_covariance import SpreadDisplay
from studio.displays.poses import pose_properties
from studio.displays.properties import Property
from studio.displays.turning import angle_between_rad

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.history import Entry
    from studio.displays.pose_with_covariance import Spread

_UNDER: Final = "Shape/"
_NOT_UNIT: Final = (
    "The orientation is no quaternion of length 1, so the pose is not drawn: its publisher should "
    "divide it by its length."
)
# How far the square of the length may be from 1, as in RViz.
_SQUARE_OFF_MAX: Final = 0.01


class OdometryDisplay(SpreadDisplay):
    """Draws a pose whenever the robot moved far enough from the last one that is drawn."""

    KIND = "Odometry"
    DOC = "Where a robot was, step by step."
    ICON = "odometry"
    TOPICS = (TopicRole("", ("nav_msgs/msg/Odometry",), newest_only=False),)
    PROPERTIES = (
        Property("Position Tolerance", "number", 0.1,
                 "How far the robot moves until another pose is drawn.", 0.0, 1e6, "m"),
        Property("Angle Tolerance", "number", 0.1,
                 "How far the robot turns until another pose is drawn.", 0.0, math.pi, "rad"),
        Property("Keep", "whole", 100,
                 f"How many poses are shown; 0 shows all, up to {KEPT_MAX:,}.", 0, KEPT_MAX),
        *pose_properties(_UNDER),
        *COVARIANCE,
    )  # fmt: skip
    KEEPS = "Keep"
    UNDER = _UNDER

    def read(self, received: Received) -> Entry[Spread] | None:
        """Return the pose, unless it cannot be drawn or is near the last one."""
        entry = super().read(received)
        return None if entry is None or self._is_near_the_newest(entry) else entry

    def takes_turn(self, turn: Any) -> bool:  # noqa: ANN401 - a message
        """Refuse what is no quaternion of length 1."""
        square = math.fsum(min(abs(part), 2.0) ** 2 for part in (turn.w, turn.x, turn.y, turn.z))
        is_unit = abs(square - 1.0) < _SQUARE_OFF_MAX
        if not is_unit:
            self.refuse("bad_message", _NOT_UNIT)
        return is_unit

    def _is_near_the_newest(self, entry: Entry[Spread]) -> bool:
        """Whether a pose is in the same frame and neither moved nor turned far."""
        newest = self.newest
        if newest is None or newest.frame != entry.frame:
            return False
        before, now = newest.content.pose, entry.content.pose
        moved_m = float(np.linalg.norm(now.xyz[0] - before.xyz[0]))
        turned_rad = angle_between_rad(before.wxyz[0], now.wxyz[0])
        return moved_m < self.number("Position Tolerance") and turned_rad < self.number(
            "Angle Tolerance"
        )
