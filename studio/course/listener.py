"""Listener: logs what is published on /chatter.

Try: `studio demos listener`, then `studio topic pub /chatter std_msgs/msg/String "data: hello"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.std_msgs.msg import String


class SubscriberNode(Node):
    """Subscribes, and logs each message."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.sub = self.create_subscription(String, "chatter", self.listener_callback, 10)

    def listener_callback(self, msg: String) -> None:
        """Log a message."""
        self.get_logger().info('I heard: "%s"' % msg.data)


def main(args: list[str] | None = None) -> None:
    """Listen until stopped."""
    with until_stopped(args):
        rclpy.spin(SubscriberNode("topic_helloworld_sub"))


if __name__ == "__main__":
    main()
