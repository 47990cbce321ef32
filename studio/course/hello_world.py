"""Hello world: logs "Hello World" twice a second, by a timer, so that the node can be asked, too.

Try: `studio demos hello_world`, then `studio node list` and `studio topic echo /rosout`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node


class HelloWorldNode(Node):
    """Logs, and does nothing else."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.timer = self.create_timer(0.5, self.timer_callback)

    def timer_callback(self) -> None:
        """Greet once more."""
        self.get_logger().info("Hello World")


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(HelloWorldNode("node_helloworld_class"))


if __name__ == "__main__":
    main()
