"""PoseWithCovarianceDisplay: a pose, and how sure it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.displays import covariance_look
from studio.displays.covariance_look import (
    NOT_POSITIVE,
    Spread,
    covariance_shapes,
    is_covariance,
    spread_of,
)
from studio.displays.display import TopicRole
from studio.displays.history import Entry, HistoryDisplay, frame_and_stamp
from studio.displays.pose_look import (
    NO_TURN_SET,
    NOT_FINITE,
    has_no_turn,
    pose_of,
    pose_properties,
    pose_shapes,
)

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape


class PoseWithCovarianceDisplay(HistoryDisplay[Spread]):
    """Draws the newest pose."""

    KIND = "PoseWithCovariance"
    DOC = "A pose and how sure it is, as a localisation tells it."
    TOPICS = (TopicRole("", ("geometry_msgs/msg/PoseWithCovarianceStamped",)),)
    PROPERTIES = (*pose_properties(), *covariance_look.PROPERTIES)

    def read(self, received: Received) -> Entry[Spread] | None:
        """The pose and its covariance, unless their numbers cannot be drawn."""
        message = self.decode(received)
        pose = pose_of(message.pose.pose)
        spread = None if pose is None else spread_of(pose, message.pose.covariance)
        if spread is None:
            return self.refuse("not_finite", NOT_FINITE)
        if has_no_turn(message.pose.pose.orientation):
            self.warn(None, NO_TURN_SET)
        if not is_covariance(spread):
            self.warn(None, NOT_POSITIVE)
        return Entry(*frame_and_stamp(message.header), spread)

    def shapes(self, content: Spread) -> dict[str, Shape]:
        """The pose, an ellipsoid, and the spread of its axes."""
        return pose_shapes(content.pose, self.values) | covariance_shapes(content, self.values)
