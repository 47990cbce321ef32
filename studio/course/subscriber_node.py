"""Subscriber: logs what comes on /topic_name.

Try: `studio demos publisher_node subscriber_node`, stop the publisher, start it again.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.std_msgs.msg import String


class SubscriberNode(Node):
    """Subscribes, and logs each message."""

    def __init__(self) -> None:
        super().__init__("subscriber_node")
        self.subscription = self.create_subscription(
            String, "topic_name", self.listener_callback, 10
        )
        self.get_logger().info("Subscriber Node initialized")

    def listener_callback(self, msg: String) -> None:
        """Log a message."""
        self.get_logger().info(f'I heard: "{msg.data}"')


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(SubscriberNode())


if __name__ == "__main__":
    main()
