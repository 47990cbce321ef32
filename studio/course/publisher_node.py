"""Publisher: counted greetings on /topic_name, twice a second.

Try: `studio demos publisher_node subscriber_node`, then `studio topic info -v /topic_name`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.std_msgs.msg import String


class PublisherNode(Node):
    """Publishes by a timer."""

    def __init__(self) -> None:
        super().__init__("publisher_node")
        self.publisher = self.create_publisher(String, "topic_name", 10)
        timer_period = 0.5
        self.timer = self.create_timer(timer_period, self.timer_callback)
        self.i = 0
        self.get_logger().info("Publisher Node initialized")

    def timer_callback(self) -> None:
        """Send the next one."""
        msg = String()
        msg.data = f"Hello World: {self.i}"
        self.publisher.publish(msg)
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.i += 1


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(PublisherNode())


if __name__ == "__main__":
    main()
