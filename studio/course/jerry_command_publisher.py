"""Jerry's commander: a random command on /jerry_command every second.

Try: `studio demos jerry_robot jerry_command_publisher`, then `studio topic echo /jerry_command`.
"""

from __future__ import annotations

import random

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.pkg_with_interfaces.msg import JerryCommand

DIRECTIONS = ("forward", "backward", "left", "right")


class CommandPublisher(Node):
    """Sends Jerry about."""

    def __init__(self) -> None:
        super().__init__("command_publisher_node")
        self.publisher = self.create_publisher(JerryCommand, "jerry_command", 10)
        self.timer = self.create_timer(1.0, self.publish_command)

    def publish_command(self) -> None:
        """Send one to five steps in one of the four directions."""
        msg = JerryCommand(direction=random.choice(DIRECTIONS), steps=random.randint(1, 5))
        self.publisher.publish(msg)
        self.get_logger().info(f"{msg.steps} steps {msg.direction}")


def main(args: list[str] | None = None) -> None:
    """Command until stopped."""
    with until_stopped(args):
        rclpy.spin(CommandPublisher())


if __name__ == "__main__":
    main()
