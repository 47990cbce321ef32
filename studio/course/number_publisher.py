"""Number publisher: the number 2 on /number, every second.

Try: `studio demos number_publisher number_counter`, then `studio topic echo /number`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.example_interfaces.msg import Int64


class FirstPub(Node):
    """Publishes a number by a timer."""

    def __init__(self) -> None:
        super().__init__("my_tiny_pub")

        self.number_ = 2
        self.number_publisher_ = self.create_publisher(Int64, "number", 10)
        self.number_timer_ = self.create_timer(1.0, self.publish_number)

    def publish_number(self) -> None:
        """Send the number once more."""
        msg = Int64()
        msg.data = self.number_
        self.number_publisher_.publish(msg)


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(FirstPub())


if __name__ == "__main__":
    main()
