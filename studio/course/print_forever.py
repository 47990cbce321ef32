"""Print forever: counts in its log, once a second.

Try: `studio run py_pkg_node print_forever_node`, then `studio topic echo /rosout`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node


class PrintForever(Node):
    """Counts what it has printed."""

    def __init__(self) -> None:
        super().__init__("print_forever")
        timer_period: float = 1.0
        self.timer = self.create_timer(timer_period, self.timer_callback)
        self.print_count: int = 0

    def timer_callback(self) -> None:
        """Log the count, then add one."""
        self.get_logger().info(f"Printed {self.print_count} times.")
        self.print_count += 1


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(PrintForever())


if __name__ == "__main__":
    main()
