"""Turtle teleop: the arrow keys drive /turtle1, and eight letters turn it to a heading.

Try: `studio demos turtlesim_node` in one terminal, `studio run turtlesim turtle_teleop_key` in
another, with the second one in front.
"""

from __future__ import annotations

import math
import threading
from contextlib import suppress
from typing import Any

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.course.turtlesim.keyboard import key_presses
from studio.ros.action import ActionClient, ClientGoalHandle
from studio.ros.client import ExternalShutdownException, Future, Node
from studio.ros.messages.geometry_msgs.msg import Twist
from studio.ros.messages.turtlesim.action import RotateAbsolute

SPEEDS = {"up": (2.0, 0.0), "down": (-2.0, 0.0), "left": (0.0, 2.0), "right": (0.0, -2.0)}
"""Metres per second ahead, radians per second to the left."""
HEADINGS = {
    "g": 0.0, "t": math.pi / 4, "r": math.pi / 2, "e": 3 * math.pi / 4,
    "d": math.pi, "c": -3 * math.pi / 4, "v": -math.pi / 2, "b": -math.pi / 4,
}  # fmt: skip
"""Radians; the keys lie around F as the headings do."""
HELP = """\
Arrow keys move the turtle. G T R E D C V B turn it, as they lie around F; F stops that. Q quits."""


class TeleopTurtle(Node):
    """Sends what a key means."""

    def __init__(self) -> None:
        super().__init__("teleop_turtle")
        self.twists = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self.rotate = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self.goal: ClientGoalHandle | None = None

    def press(self, key: str) -> bool:
        """Do what a key means; False to quit."""
        if key in SPEEDS:
            twist = Twist()
            twist.linear.x, twist.angular.z = SPEEDS[key]
            self.twists.publish(twist)
        elif key.lower() in HEADINGS:
            goal = RotateAbsolute.Goal(theta=HEADINGS[key.lower()])
            self.rotate.send_goal_async(goal).add_done_callback(self.on_goal)
        elif key.lower() == "f" and self.goal is not None:
            self.goal.cancel_goal_async()
        return key.lower() != "q"

    def on_goal(self, future: Future[Any]) -> None:
        """Keep the goal, to cancel it by F."""
        self.goal = future.result()


def main(args: list[str] | None = None) -> None:
    """Read keys in this thread, and spin in another."""
    with until_stopped(args), key_presses() as next_key:
        node = TeleopTurtle()
        threading.Thread(target=spin_quietly, args=(node,), daemon=True).start()
        node.get_logger().info(HELP)
        while rclpy.ok() and node.press(next_key()):
            pass


def spin_quietly(node: Node) -> None:
    """Spin until the other thread ends."""
    with suppress(ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()
