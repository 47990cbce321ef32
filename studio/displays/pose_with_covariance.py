"""PoseWithCovarianceDisplay: a pose, and how sure it is."""

from __future__ import annotations

from typing import Any

from studio.displays import covariance_look
from studio.displays.display import TopicRole
from studio.displays.pose_look import NO_TURN_SET, has_no_turn, pose_properties
from studio.displays.spread_display import SpreadDisplay


class PoseWithCovarianceDisplay(SpreadDisplay):
    """Draws the newest pose."""

    KIND = "PoseWithCovariance"
    DOC = "A pose and how sure it is, as a localisation tells it."
    TOPICS = (TopicRole("", ("geometry_msgs/msg/PoseWithCovarianceStamped",)),)
    PROPERTIES = (*pose_properties(), *covariance_look.PROPERTIES)

    def takes_turn(self, turn: Any) -> bool:  # noqa: ANN401 - a message
        """Takes any: where none is set, it is said."""
        if has_no_turn(turn):
            self.warn(None, NO_TURN_SET)
        return True
