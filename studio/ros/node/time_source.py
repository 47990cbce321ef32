"""TimeSource: lets /clock tell a node the time, while `use_sim_time` is set."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.node.time import stamp_ns
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from studio.ros.node.node import Node
    from studio.ros.node.subscription import Subscription
    from studio.ros.types.classes import MessageValue

CLOCK_TOPIC = "/clock"
CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class TimeSource:
    """Follows /clock; until it tells something, the time is zero, as in rclpy."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._subscription: Subscription | None = None
        # The clock goes on beside callbacks that wait for it, where there are threads for both.
        self._group = ReentrantCallbackGroup()

    @property
    def ros_time_is_active(self) -> bool:
        """Whether /clock is followed."""
        return self._subscription is not None

    @ros_time_is_active.setter
    def ros_time_is_active(self, active: bool) -> None:
        if active == self.ros_time_is_active:
            return
        if active:
            self._follow()
        else:
            self._leave()

    def _follow(self) -> None:
        self._node.get_clock().tell(0)
        self._subscription = self._node.create_subscription(
            self._node.wire.types.message("rosgraph_msgs/msg/Clock"),
            CLOCK_TOPIC,
            self._told,
            CLOCK_QOS,
            callback_group=self._group,
        )

    def _leave(self) -> None:
        followed, self._subscription = self._subscription, None
        if followed is not None:
            self._node.destroy_subscription(followed)
        self._node.get_clock().tell(None)

    def _told(self, clock: MessageValue) -> None:
        if self._subscription is not None:
            self._node.get_clock().tell(max(0, stamp_ns(clock.clock)))
