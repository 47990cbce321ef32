"""R2D2 drives in a circle, turns its head and moves its periscope: /joint_states and /tf.

Try: `studio demos state_publisher`, then `studio topic hz /joint_states` (30) and
`studio topic echo --once /tf`.
"""

from __future__ import annotations

from contextlib import suppress
from math import cos, pi, sin

import studio.ros.client as rclpy
from studio.ros.client import ExternalShutdownException, Node, QoSProfile
from studio.ros.messages.geometry_msgs.msg import Quaternion, TransformStamped
from studio.ros.messages.sensor_msgs.msg import JointState
from studio.tf2.broadcasters import TransformBroadcaster


class StatePublisher(Node):
    """Publishes from within its constructor, until ROS is shut down."""

    def __init__(self) -> None:  # noqa: PLR0915  # one loop, as in the course
        rclpy.init()
        super().__init__("state_publisher")

        qos_profile = QoSProfile(depth=10)
        self.joint_pub = self.create_publisher(JointState, "joint_states", qos_profile)
        self.broadcaster = TransformBroadcaster(self, qos=qos_profile)
        self.nodeName = self.get_name()
        self.get_logger().info("{0} started".format(self.nodeName))  # noqa: UP030, UP032

        degree = pi / 180.0
        loop_rate = self.create_rate(30)

        tilt = 0.0
        tinc = degree
        swivel = 0.0
        angle = 0.0
        height = 0.0
        hinc = 0.005

        odom_trans = TransformStamped()
        odom_trans.header.frame_id = "odom"
        odom_trans.child_frame_id = "axis"
        joint_state = JointState()

        try:
            while rclpy.ok():
                rclpy.spin_once(self)

                now = self.get_clock().now()
                joint_state.header.stamp = now.to_msg()
                joint_state.name = ["swivel", "tilt", "periscope"]
                joint_state.position = [swivel, tilt, height]

                odom_trans.header.stamp = now.to_msg()
                odom_trans.transform.translation.x = cos(angle) * 2
                odom_trans.transform.translation.y = sin(angle) * 2
                odom_trans.transform.translation.z = 0.7
                odom_trans.transform.rotation = euler_to_quaternion(0, 0, angle + pi / 2)

                self.joint_pub.publish(joint_state)
                self.broadcaster.sendTransform(odom_trans)

                tilt += tinc
                if tilt < -0.5 or tilt > 0.0:
                    tinc *= -1
                height += hinc
                if height > 0.2 or height < 0.0:
                    hinc *= -1
                swivel += degree
                angle += degree / 4

                loop_rate.sleep()

        except KeyboardInterrupt:
            pass


def euler_to_quaternion(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Return the quaternion of roll, pitch and yaw, radians."""
    qx = sin(roll / 2) * cos(pitch / 2) * cos(yaw / 2) - cos(roll / 2) * sin(pitch / 2) * sin(
        yaw / 2
    )
    qy = cos(roll / 2) * sin(pitch / 2) * cos(yaw / 2) + sin(roll / 2) * cos(pitch / 2) * sin(
        yaw / 2
    )
    qz = cos(roll / 2) * cos(pitch / 2) * sin(yaw / 2) - sin(roll / 2) * sin(pitch / 2) * cos(
        yaw / 2
    )
    qw = cos(roll / 2) * cos(pitch / 2) * cos(yaw / 2) + sin(roll / 2) * sin(pitch / 2) * sin(
        yaw / 2
    )
    return Quaternion(x=qx, y=qy, z=qz, w=qw)


def main(args: list[str] | None = None) -> None:
    """Publish until stopped."""
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        StatePublisher()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
