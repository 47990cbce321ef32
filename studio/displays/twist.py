"""TwistDisplay: a velocity and a turning rate as arrows."""

from __future__ import annotations

from typing import Any

from studio.displays.display import TopicRole
from studio.displays.vector_display import SCREW, SCREW_PROPERTIES, VectorDisplay


class TwistDisplay(VectorDisplay):
    """Draws the last twists."""

    KIND = "TwistStamped"
    DOC = "A velocity and a turning rate, as a robot is told to drive."
    TOPICS = (TopicRole("", ("geometry_msgs/msg/TwistStamped",), newest_only=False),)
    PROPERTIES = SCREW_PROPERTIES
    NAMES = SCREW

    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """The velocity and the turning rate."""
        return message.twist.linear, message.twist.angular
