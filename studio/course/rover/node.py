"""RoverNode: drives, measures and publishes, each at its own rate."""

from __future__ import annotations

from studio.course.rover.body import Body, pan_rad
from studio.course.rover.drive import Drive
from studio.course.rover.health import Health
from studio.course.rover.model import is_published_by_others
from studio.course.rover.round_trip import RoundTrip
from studio.course.rover.sensors import SCAN_S, Camera, Lidar
from studio.course.rover.surroundings import Surroundings
from studio.ros.client import Node
from studio.ros.messages.builtin_interfaces.msg import Time
from studio.ros.messages.geometry_msgs.msg import Twist

STEP_S, CAMERA_S = 1 / 30, 0.2
TAKES_OVER_S = 5.0
"""Time without a command after which it goes on by itself."""


class RoverNode(Node):
    """One robot's topics, in one node."""

    def __init__(self) -> None:
        super().__init__("rover")
        self.declare_parameter("autopilot", value=True)
        self.drive, self.trip = Drive(), RoundTrip()
        self.seconds, self.idle_s, self.is_blocked = 0.0, TAKES_OVER_S, False
        self.body, self.lidar, self.camera = Body(self), Lidar(self), Camera(self)
        self.health, self.surroundings = Health(self), Surroundings(self, self.trip)
        self.create_subscription(Twist, "cmd_vel", self.on_command, 10)
        self.create_timer(STEP_S, self.on_step)
        self.create_timer(SCAN_S, lambda: self.lidar.publish(self.stamp(), self.drive))
        self.create_timer(CAMERA_S, self.on_picture)
        self.create_timer(1.0, self.on_second)
        self.get_logger().info("The rover is on its way: /cmd_vel takes the wheel.")

    def stamp(self) -> Time:
        """Return the stamp of messages sent now."""
        return self.get_clock().now().to_msg()

    def on_command(self, msg: Twist) -> None:
        """Let somebody drive."""
        if self.idle_s >= TAKES_OVER_S:
            self.get_logger().info("Somebody drives.")
        self.idle_s = 0.0
        self.drive.command(msg.linear.x, msg.angular.z)

    def on_step(self) -> None:
        """Drive on, by itself if nobody else does, and publish the motion."""
        was_driven = self.idle_s < TAKES_OVER_S
        self.seconds += STEP_S
        self.idle_s += STEP_S
        if self.idle_s >= TAKES_OVER_S and self.get_parameter("autopilot").value:
            if was_driven:
                self.get_logger().info("Nobody drives: on my way again.")
            self.drive.command(*self.trip.steer(self.drive.x, self.drive.y, self.drive.yaw))
        self.is_blocked = not self.drive.step(STEP_S)
        self.body.publish(self.stamp(), self.drive, self.seconds)

    def on_picture(self) -> None:
        """Take a picture."""
        self.camera.publish(self.stamp(), self.drive, pan_rad(self.seconds))

    def on_second(self) -> None:
        """Publish what changes slowly; joints that another node publishes are left to it."""
        self.body.publishes_joints = not is_published_by_others(self, "/joint_states")
        self.surroundings.publish(self.stamp(), self.drive)
        self.health.publish(self.stamp(), self.drive, self.seconds, is_blocked=self.is_blocked)
        if self.is_blocked:
            self.get_logger().warn("A wall is in the way.", throttle_duration_sec=5.0)
