"""Talker: publishes "Hello World" on /chatter twice a second.

Try: `studio demos talker listener`, then `studio topic echo /chatter` and
`studio topic hz /chatter`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.std_msgs.msg import String


class PublisherNode(Node):
    """Publishes by a timer."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.pub = self.create_publisher(String, "chatter", 10)
        self.timer = self.create_timer(0.5, self.timer_callback)

    def timer_callback(self) -> None:
        """Publish it once more."""
        msg = String()
        msg.data = "Hello World"
        self.pub.publish(msg)
        self.get_logger().info('Publishing: "%s"' % msg.data)


def main(args: list[str] | None = None) -> None:
    """Talk until stopped."""
    with until_stopped(args):
        rclpy.spin(PublisherNode("topic_helloworld_pub"))


if __name__ == "__main__":
    main()
