"""AccelDisplay: an acceleration along and about an axis as arrows."""

from __future__ import annotations

from typing import Any

from studio.displays.display import TopicRole
from studio.displays.vector_display import SCREW, SCREW_PROPERTIES, VectorDisplay


class AccelDisplay(VectorDisplay):
    """Draws the last accelerations."""

    KIND = "AccelStamped"
    DOC = "An acceleration along and about an axis."
    TOPICS = (TopicRole("", ("geometry_msgs/msg/AccelStamped",), newest_only=False),)
    PROPERTIES = SCREW_PROPERTIES
    NAMES = SCREW

    def parts(self, message: Any) -> tuple[Any, Any]:  # noqa: ANN401 - messages
        """Both accelerations."""
        return message.accel.linear, message.accel.angular
