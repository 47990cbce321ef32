"""Timer node: a counted message on /timer_topic, twice a second.

Try: `studio demos timer_node`, then `studio topic hz /timer_topic`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.std_msgs.msg import String


class TimerNode(Node):
    """Publishes by a timer."""

    def __init__(self) -> None:
        super().__init__("timer_node")
        self.publisher = self.create_publisher(String, "timer_topic", 10)
        timer_period = 0.5
        self.timer = self.create_timer(timer_period, self.timer_callback)
        self.i = 0
        self.get_logger().info("Timer Node initialized")

    def timer_callback(self) -> None:
        """Send the next one."""
        msg = String()
        msg.data = f"Timer message: {self.i}"
        self.publisher.publish(msg)
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.i += 1


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(TimerNode())


if __name__ == "__main__":
    main()
