"""The robot of a classroom on DDS: a small body with two wheels that drives as /cmd_vel says.

`/driver` has the parameter `speed_max_m_s`, which holds, and the service `/reset_odometry`.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any, Final

from studio.ros.cdr import codec_of
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue
    from tests.support.dds_actions import Say
    from tests.support.dds_node import DdsProcess

_LATCHED: Final = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_SENSOR: Final = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
_MOVE_HZ: Final = 20.0
_SCAN_HZ: Final = 10.0
_CHAT_HZ: Final = 2.0
_RAYS: Final = 180
_ROOM_M: Final = 3.0
_LASER_X_M: Final = 0.15
_WHEEL_RADIUS_M: Final = 0.05
_TRACK_M: Final = 0.3
_COMMAND_LASTS_S: Final = 0.5
"""Older commands move it no more."""
SPEED_MAX: Final = "speed_max_m_s"
WHEELS: Final = ("left_wheel", "right_wheel")
URDF: Final = """<robot name="classroom">
  <link name="base_link">
    <visual><geometry><box size="0.4 0.3 0.1"/></geometry></visual>
  </link>
  <link name="laser"><visual><geometry><box size="0.05 0.05 0.05"/></geometry></visual></link>
  <joint name="laser_joint" type="fixed">
    <parent link="base_link"/><child link="laser"/><origin xyz="0.15 0 0.1"/>
  </joint>
  <link name="left_wheel_link">
    <visual><geometry><cylinder radius="0.05" length="0.03"/></geometry></visual>
  </link>
  <joint name="left_wheel" type="continuous">
    <parent link="base_link"/><child link="left_wheel_link"/>
    <origin xyz="0 0.15 0" rpy="-1.5708 0 0"/><axis xyz="0 0 1"/>
  </joint>
  <link name="right_wheel_link">
    <visual><geometry><cylinder radius="0.05" length="0.03"/></geometry></visual>
  </link>
  <joint name="right_wheel" type="continuous">
    <parent link="base_link"/><child link="right_wheel_link"/>
    <origin xyz="0 -0.15 0" rpy="-1.5708 0 0"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""


class ClassroomRobot:
    """Three nodes: `/driver` with the body, `/laser` with the scan, and `/talker`."""

    def __init__(self, process: DdsProcess, say: Say) -> None:
        self._types, self._say = process.types, say
        self._x_m = self._y_m = self._yaw = 0.0
        self._speed_m_s = self._turn_rad_s = 0.0
        self._commanded_s = -math.inf
        self._wheels = [0.0, 0.0]
        self._said = 0
        driver, laser, talker = (process.node(name) for name in ("driver", "laser", "talker"))
        self._driver = driver
        text, tf, twist = "std_msgs/msg/String", "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/Twist"
        kind = self._types.message
        self._twist = codec_of(kind(twist))
        description = driver.create_publisher(kind(text), "/robot_description", _LATCHED)
        fixed = driver.create_publisher(kind(tf), "/tf_static", _LATCHED)
        self._tf = driver.create_publisher(kind(tf), "/tf", QoSProfile(depth=100))
        self._joints = driver.create_publisher(
            kind("sensor_msgs/msg/JointState"), "/joint_states", 10
        )
        self._odom = driver.create_publisher(kind("nav_msgs/msg/Odometry"), "/odom", 10)
        driver.create_subscription(kind(twist), "/cmd_vel", self._command, 10)
        self._scan = laser.create_publisher(kind("sensor_msgs/msg/LaserScan"), "/scan", _SENSOR)
        self._chatter = talker.create_publisher(kind(text), "/chatter", 10)
        description.publish(kind(text)(data=URDF))
        fixed.publish(
            kind(tf)(transforms=[self._transform("base_link", "laser", _LASER_X_M, 0.0, 0.1)])
        )
        driver.open_parameters(driver, self._types)
        driver.declare_parameter(SPEED_MAX, 1.0)
        trigger = self._types.service("std_srvs/srv/Trigger")
        driver.create_service(trigger, "/reset_odometry", self._reset)
        process.every(1.0 / _MOVE_HZ, self._move)
        process.every(1.0 / _SCAN_HZ, self._look)
        process.every(1.0 / _CHAT_HZ, self._talk)

    def _command(self, cdr: bytes) -> None:
        told = self._twist.decode(cdr)
        fastest_m_s = float(self._driver.get_parameter(SPEED_MAX).value)
        self._speed_m_s = max(-fastest_m_s, min(fastest_m_s, float(told.linear.x)))
        self._turn_rad_s = float(told.angular.z)
        self._commanded_s = time.monotonic()
        self._say("cmd_vel", linear_m_s=self._speed_m_s, angular_rad_s=self._turn_rad_s)

    def _reset(self, request: MessageValue, response: MessageValue) -> MessageValue:
        del request
        self._x_m = self._y_m = self._yaw = 0.0
        response.success, response.message = True, "odometry is at zero"
        return response

    def _move(self) -> None:
        if time.monotonic() - self._commanded_s > _COMMAND_LASTS_S:
            self._speed_m_s = self._turn_rad_s = 0.0
        step_s = 1.0 / _MOVE_HZ
        self._yaw += self._turn_rad_s * step_s
        self._x_m += self._speed_m_s * math.cos(self._yaw) * step_s
        self._y_m += self._speed_m_s * math.sin(self._yaw) * step_s
        for at, side in enumerate((-1, 1)):
            speed_m_s = self._speed_m_s + side * self._turn_rad_s * _TRACK_M / 2
            self._wheels[at] += speed_m_s * step_s / _WHEEL_RADIUS_M
        base = self._transform("odom", "base_link", self._x_m, self._y_m, _WHEEL_RADIUS_M)
        base.transform.rotation = self._rotation()
        wheels = [
            self._transform("base_link", f"{name}_link", 0.0, side * _TRACK_M / 2, 0.0)
            for name, side in zip(WHEELS, (1, -1), strict=True)
        ]
        for wheel, angle in zip(wheels, self._wheels, strict=True):
            wheel.transform.rotation = self._rolled(angle)
        self._tf.publish(self._types.message("tf2_msgs/msg/TFMessage")(transforms=[base, *wheels]))
        self._joints.publish(
            self._types.message("sensor_msgs/msg/JointState")(
                header=self._header("base_link"), name=list(WHEELS), position=list(self._wheels)
            )
        )
        odom: Any = self._types.message("nav_msgs/msg/Odometry")(
            header=self._header("odom"), child_frame_id="base_link"
        )
        odom.pose.pose.position.x, odom.pose.pose.position.y = self._x_m, self._y_m
        odom.pose.pose.orientation = self._rotation()
        odom.twist.twist.linear.x = self._speed_m_s
        odom.twist.twist.angular.z = self._turn_rad_s
        self._odom.publish(odom)

    def _look(self) -> None:
        """The walls of a square room around where it began."""
        step = 2 * math.pi / _RAYS
        ranges = [self._wall_m(self._yaw - math.pi + at * step) for at in range(_RAYS)]
        self._scan.publish(
            self._types.message("sensor_msgs/msg/LaserScan")(
                header=self._header("laser"),
                angle_min=-math.pi,
                angle_max=math.pi - step,
                angle_increment=step,
                scan_time=1.0 / _SCAN_HZ,
                range_min=0.05,
                range_max=10.0,
                ranges=ranges,
            )
        )

    def _wall_m(self, angle: float) -> float:
        """From the laser, which stands ahead of the middle of the body."""
        reach: list[float] = []
        x_m = self._x_m + _LASER_X_M * math.cos(self._yaw)
        y_m = self._y_m + _LASER_X_M * math.sin(self._yaw)
        for at, direction in ((x_m, math.cos(angle)), (y_m, math.sin(angle))):
            if abs(direction) > 1e-9:
                reach.append((math.copysign(_ROOM_M, direction) - at) / direction)
        return max(0.0, min(reach))

    def _talk(self) -> None:
        self._said += 1
        text = self._types.message("std_msgs/msg/String")
        self._chatter.publish(text(data=f"The robot says {self._said}"))

    def _header(self, frame: str) -> MessageValue:
        kind = self._types.message("std_msgs/msg/Header")
        return kind(frame_id=frame, stamp=self._driver.now())

    def _transform(self, parent: str, child: str, *xyz_m: float) -> Any:  # noqa: ANN401
        made: Any = self._types.message("geometry_msgs/msg/TransformStamped")(
            header=self._header(parent), child_frame_id=child
        )
        at = made.transform.translation
        at.x, at.y, at.z = xyz_m
        made.transform.rotation.w = 1.0
        return made

    def _rotation(self) -> MessageValue:
        half = self._yaw / 2
        return self._quaternion(0.0, 0.0, math.sin(half), math.cos(half))

    def _rolled(self, angle: float) -> MessageValue:
        """A wheel lies on its side, then turns: rpy (-pi/2, 0, 0), then about its own z."""
        side = math.sqrt(0.5)
        sine, cosine = math.sin(angle / 2), math.cos(angle / 2)
        return self._quaternion(-side * cosine, side * sine, side * sine, side * cosine)

    def _quaternion(self, *xyzw: float) -> MessageValue:
        kind = self._types.message("geometry_msgs/msg/Quaternion")
        return kind(**dict(zip("xyzw", xyzw, strict=True)))
