"""Number counter: adds up what comes on /number.

Try: `studio demos number_publisher number_counter`: the counter grows by 2 each second. Then
`studio topic pub --once /number example_interfaces/msg/Int64 "data: -100"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.example_interfaces.msg import Int64


class FirstSub(Node):
    """Adds up numbers."""

    def __init__(self) -> None:
        super().__init__("my_tiny_sub")
        self.number_subscriber = self.create_subscription(Int64, "number", self.number_callback, 10)
        self.counter_ = 0

    def number_callback(self, msg: Int64) -> None:
        """Add a number and log the sum."""
        self.counter_ += msg.data
        self.get_logger().info("Counter: " + str(self.counter_))


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(FirstSub())


if __name__ == "__main__":
    main()
