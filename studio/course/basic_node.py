"""A node that logs one line: it exists.

Try: `studio run my_robot_package basic_node`, then `studio topic echo /rosout` before you start it.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node


class BasicNode(Node):
    """Logs once."""

    def __init__(self) -> None:
        super().__init__("basic_node")
        self.get_logger().info("Basic Node initialized")


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(BasicNode())


if __name__ == "__main__":
    main()
