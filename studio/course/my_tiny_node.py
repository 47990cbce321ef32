"""A node with a timer: logs "Hello" and a number every second.

Try: `studio run my_py_pkg my_tiny_node`, then `studio topic echo /rosout --field msg`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node


class MyFirstNode(Node):
    """Counts in its log."""

    def __init__(self) -> None:
        super().__init__("my_tiny_node")
        self.counter_ = 0
        self.timer_ = self.create_timer(1.0, self.print_hello)

    def print_hello(self) -> None:
        """Log the count, then add one."""
        self.get_logger().info("Hello " + str(self.counter_))
        self.counter_ += 1


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(MyFirstNode())


if __name__ == "__main__":
    main()
