"""Body: what the rover knows of itself: joints, odometry, inertia, and where odom is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from studio.ros.messages.geometry_msgs.msg import Quaternion, TransformStamped
from studio.ros.messages.nav_msgs.msg import Odometry
from studio.ros.messages.sensor_msgs.msg import Imu, JointState
from studio.tf2.broadcasters import StaticTransformBroadcaster, TransformBroadcaster

if TYPE_CHECKING:
    from studio.course.rover.drive import Drive
    from studio.ros.client import Node
    from studio.ros.messages.builtin_interfaces.msg import Time

GRAVITY_M_S2 = 9.80665
_WHEELS = ("front_left", "front_right", "rear_left", "rear_right")
_ARM = {
    "arm_turret_joint": (0.5, 9.0),
    "arm_shoulder_joint": (0.15, 7.0),
    "arm_elbow_joint": (0.2, 5.0),
    "arm_wrist_joint": (0.3, 6.0),
    "arm_roll_joint": (0.8, 8.0),
    "gripper_joint": (0.008, 4.0),
}
"""The amplitude of each joint, rad or m, and its period, s."""
_PAN_RAD, _PAN_S, _TILT_RAD, _TILT_S = 0.9, 12.0, 0.15, 8.0


class Body:
    """Publishes /joint_states, /odom, /imu and the transforms above the robot's own."""

    def __init__(self, node: Node) -> None:
        self.publishes_joints = True
        self._joints = node.create_publisher(JointState, "joint_states", 10)
        self._odometry = node.create_publisher(Odometry, "odom", 10)
        self._imu = node.create_publisher(Imu, "imu", 10)
        self._moving = TransformBroadcaster(node)
        self._still = StaticTransformBroadcaster(node)
        map_from_odom = TransformStamped(child_frame_id="odom")
        map_from_odom.header.frame_id = "map"
        map_from_odom.header.stamp = node.get_clock().now().to_msg()
        self._still.sendTransform(map_from_odom)

    def publish(self, stamp: Time, drive: Drive, seconds: float) -> None:
        """Publish the state `seconds` after the start."""
        if self.publishes_joints:
            self._publish_joints(stamp, drive, seconds)
        self._publish_odometry(stamp, drive)
        self._publish_imu(stamp, drive)

    def _publish_joints(self, stamp: Time, drive: Drive, seconds: float) -> None:
        left, right = (math.remainder(turned, math.tau) for turned in drive.wheels_rad)
        positions = {
            f"{wheel}_wheel_joint": right if "right" in wheel else left for wheel in _WHEELS
        }
        positions |= {"mast_pan_joint": pan_rad(seconds)}
        positions |= {"mast_tilt_joint": _swing(_TILT_RAD, _TILT_S, seconds)}
        positions |= {joint: _swing(*swing, seconds) for joint, swing in _ARM.items()}
        state = JointState(name=list(positions), position=list(positions.values()))
        state.header.stamp = stamp
        self._joints.publish(state)

    def _publish_odometry(self, stamp: Time, drive: Drive) -> None:
        turned = _about_z(drive.yaw)
        odometry = Odometry(child_frame_id="base_footprint")
        odometry.header.stamp, odometry.header.frame_id = stamp, "odom"
        place = odometry.pose.pose.position
        place.x, place.y = drive.x, drive.y
        odometry.pose.pose.orientation = turned
        odometry.twist.twist.linear.x = drive.forward_m_s
        odometry.twist.twist.angular.z = drive.turn_rad_s
        self._odometry.publish(odometry)
        moved = TransformStamped(header=odometry.header, child_frame_id="base_footprint")
        moved.transform.translation.x, moved.transform.translation.y = drive.x, drive.y
        moved.transform.rotation = turned
        self._moving.sendTransform(moved)

    def _publish_imu(self, stamp: Time, drive: Drive) -> None:
        imu = Imu(orientation=_about_z(drive.yaw))
        imu.header.stamp, imu.header.frame_id = stamp, "base_link"
        imu.angular_velocity.z = drive.turn_rad_s
        imu.linear_acceleration.x = drive.acceleration_m_s2
        imu.linear_acceleration.y = drive.forward_m_s * drive.turn_rad_s
        imu.linear_acceleration.z = GRAVITY_M_S2
        self._imu.publish(imu)


def pan_rad(seconds: float) -> float:
    """Return the direction of the mast's head, to the left of ahead."""
    return _swing(_PAN_RAD, _PAN_S, seconds)


def _swing(size: float, period_s: float, seconds: float) -> float:
    return size * math.sin(math.tau * seconds / period_s)


def _about_z(angle_rad: float) -> Quaternion:
    return Quaternion(z=math.sin(angle_rad / 2), w=math.cos(angle_rad / 2))
