"""Jerry: a robot in a flat world. Follows /jerry_command, publishes /jerry/pose, serves /distance.

Try: `studio demos jerry_robot`, then `studio topic echo /jerry/pose` and
`studio topic pub --once /jerry_command pkg_with_interfaces/msg/JerryCommand
"{direction: left, steps: 3}"`.
"""

from __future__ import annotations

import math

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import DurabilityPolicy, Node, QoSProfile
from studio.ros.messages.geometry_msgs.msg import Point
from studio.ros.messages.pkg_with_interfaces.msg import JerryCommand
from studio.ros.messages.pkg_with_interfaces.srv import Distance

STEPS = {"forward": (1, 0), "backward": (-1, 0), "left": (0, 1), "right": (0, -1)}
"""The step of each direction: x points ahead and y to the left, as in ROS."""


class JerryRobot(Node):
    """Stays at the origin until the first command; one step is one metre."""

    def __init__(self) -> None:
        super().__init__("jerry_robot_node")
        self.x, self.y = 0, 0
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pose = self.create_publisher(Point, "jerry/pose", kept)
        self.create_subscription(JerryCommand, "jerry_command", self.command_callback, 10)
        self.create_service(Distance, "distance", self.distance_callback)
        self.publish_pose()

    def command_callback(self, msg: JerryCommand) -> None:
        """Go some steps; a direction that he does not know leaves him where he is."""
        if msg.direction not in STEPS or msg.steps < 0:
            self.get_logger().warn(f"I cannot go {msg.steps} steps {msg.direction!r}.")
            return
        ahead, left = STEPS[msg.direction]
        self.x += ahead * msg.steps
        self.y += left * msg.steps
        self.get_logger().info(f"{msg.steps} steps {msg.direction}: at ({self.x}, {self.y})")
        self.publish_pose()

    def distance_callback(
        self, request: Distance.Request, response: Distance.Response
    ) -> Distance.Response:
        """Return how far a place is, as the crow flies."""
        response.distance = math.hypot(request.x - self.x, request.y - self.y)
        return response

    def publish_pose(self) -> None:
        """Publish his position, also for late subscribers."""
        self.pose.publish(Point(x=float(self.x), y=float(self.y)))


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(JerryRobot())


if __name__ == "__main__":
    main()
