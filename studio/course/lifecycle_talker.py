"""Lifecycle talker: a managed node that talks on /lifecycle_chatter only while it is active.

Try: `studio demos lifecycle_talker`, then `studio topic echo /lifecycle_chatter` and, beside it,
`studio lifecycle set /lc_talker configure`, `... activate`, `... deactivate`, `... cleanup`,
`... shutdown`; `studio lifecycle get /lc_talker` prints its state.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.lifecycle import (
    LifecycleNode,
    LifecyclePublisher,
    LifecycleState,
    TransitionCallbackReturn,
)
from studio.ros.messages.std_msgs.msg import String

if TYPE_CHECKING:
    from studio.ros.client import Timer


class LifecycleTalker(LifecycleNode):
    """Makes publisher and timer when it is configured, and lets go of them when cleaned up."""

    def __init__(self) -> None:
        super().__init__("lc_talker")
        self.count = 0
        self.pub: LifecyclePublisher | None = None
        self.timer: Timer | None = None

    def publish(self) -> None:
        """Talk, if it is active: a lifecycle publisher sends nothing else."""
        self.count += 1
        if self.pub is not None:
            self.pub.publish(String(data=f"Lifecycle HelloWorld #{self.count}"))

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make what it needs."""
        self.pub = self.create_lifecycle_publisher(String, "lifecycle_chatter", 10)
        self.timer = self.create_timer(1.0, self.publish)
        self.get_logger().info("on_configure() is called.")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let the publisher send; the parent class does it."""
        self.get_logger().info("on_activate() is called.")
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let the publisher rest; the parent class does it."""
        self.get_logger().info("on_deactivate() is called.")
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let go of everything."""
        self._let_go()
        self.get_logger().info("on_cleanup() is called.")
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Let go of everything, for good."""
        self._let_go()
        self.get_logger().info("on_shutdown() is called.")
        return TransitionCallbackReturn.SUCCESS

    def _let_go(self) -> None:
        if self.timer is not None:
            self.destroy_timer(self.timer)
        if self.pub is not None:
            self.destroy_lifecycle_publisher(self.pub)
        self.timer = self.pub = None


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(LifecycleTalker())


if __name__ == "__main__":
    main()
