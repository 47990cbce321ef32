"""PoseDisplay: one pose as an arrow or as axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.displays.display import TopicRole, frame_and_stamp
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import (
    NO_TURN_SET,
    NOT_FINITE,
    Poses,
    has_no_turn,
    pose_of,
    pose_properties,
    pose_shapes,
    pose_sizes,
)
from studio.displays.selection import wxyz_of, xyz_of

if TYPE_CHECKING:
    from studio.displays.display import Received
    from studio.displays.drawing import Shape, Wxyz, Xyz


class PoseDisplay(HistoryDisplay[Poses]):
    """Draws the newest pose."""

    KIND = "Pose"
    DOC = "A pose as an arrow or as axes, as a goal of navigation is."
    ICON = "pose"
    TOPICS = (TopicRole("", ("geometry_msgs/msg/PoseStamped",)),)
    PROPERTIES = pose_properties()
    ITEM = "pose"

    def read(self, received: Received) -> Entry[Poses] | None:
        """Return the pose, unless its numbers cannot be drawn."""
        message = self.decode(received)
        poses = pose_of(message.pose)
        if poses is None:
            return self.refuse("not_finite", NOT_FINITE)
        if has_no_turn(message.pose.orientation):
            self.warn(None, NO_TURN_SET)
        return Entry(*frame_and_stamp(message.header), poses)

    def shapes(self, content: Poses) -> dict[str, Shape]:
        """Return an arrow, or axes."""
        return pose_shapes(content, self.values)

    def message_pose(self, content: Poses) -> tuple[Xyz, Wxyz]:
        """Return the pose."""
        return xyz_of(content.xyz[0]), wxyz_of(content.wxyz[0])

    def sizes(self) -> tuple[str, ...]:
        """Return the properties with the length of the arrow or the axes."""
        return pose_sizes(self.values)
