"""Sensors: the lidar's scans and the camera's pictures of the room."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from studio.course.rover.camera import HEIGHT_PX, WIDTH_PX, intrinsics, picture
from studio.course.rover.room import cast_rays
from studio.ros.client import qos_profile_sensor_data
from studio.ros.messages.sensor_msgs.msg import CameraInfo, Image, LaserScan

if TYPE_CHECKING:
    from studio.course.rover.drive import Drive
    from studio.ros.client import Node
    from studio.ros.messages.builtin_interfaces.msg import Time

BEAMS = 360
RANGE_MIN_M, RANGE_MAX_M = 0.15, 12.0
SCAN_S = 0.1
_NOISE_M = 0.008
_LASER_FRAME, _LASER_M = "laser_frame", (-0.02, 0.05)
_CAMERA_FRAME, _CAMERA_M = "left_camera_optical_frame", (-0.19, 0.10)


class Lidar:
    """Publishes /scan: one turn of beams, with the noise that lidars have."""

    def __init__(self, node: Node) -> None:
        self._scans = node.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self._angles = np.linspace(-math.pi, math.pi, BEAMS, endpoint=False)
        self._random = np.random.default_rng(1)

    def publish(self, stamp: Time, drive: Drive) -> None:
        """Scan the room from where the lidar is now."""
        x, y = _on_the_rover(drive, _LASER_M)
        distances, _ = cast_rays(x, y, self._angles + drive.yaw)
        scan = LaserScan(angle_min=-math.pi, range_min=RANGE_MIN_M, range_max=RANGE_MAX_M)
        scan.header.stamp, scan.header.frame_id = stamp, _LASER_FRAME
        scan.angle_increment = math.tau / BEAMS
        scan.angle_max = math.pi - scan.angle_increment
        scan.scan_time = SCAN_S  # and no time between beams: all of them are of this moment
        scan.ranges = distances + self._random.normal(0.0, _NOISE_M, BEAMS)
        self._scans.publish(scan)


class Camera:
    """Publishes /camera/image_raw and /camera/camera_info."""

    def __init__(self, node: Node) -> None:
        self._images = node.create_publisher(Image, "camera/image_raw", qos_profile_sensor_data)
        self._infos = node.create_publisher(
            CameraInfo, "camera/camera_info", qos_profile_sensor_data
        )

    def publish(self, stamp: Time, drive: Drive, pan_rad: float) -> None:
        """Take a picture of the room from the mast's head."""
        x, y = _on_the_rover(drive, _CAMERA_M)
        image = Image(height=HEIGHT_PX, width=WIDTH_PX, encoding="rgb8", step=3 * WIDTH_PX)
        image.header.stamp, image.header.frame_id = stamp, _CAMERA_FRAME
        image.data = picture(x, y, drive.yaw + pan_rad).ravel()
        self._images.publish(image)
        info = _camera_info()
        info.header = image.header
        self._infos.publish(info)


def _camera_info() -> CameraInfo:
    fx, fy, cx, cy = intrinsics()
    info = CameraInfo(height=HEIGHT_PX, width=WIDTH_PX, distortion_model="plumb_bob")
    info.d = [0.0] * 5
    info.k = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]
    info.r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    info.p = [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]
    return info


def _on_the_rover(drive: Drive, place_m: tuple[float, float]) -> tuple[float, float]:
    """Return where in the room a point of the rover is."""
    cosine, sine = math.cos(drive.yaw), math.sin(drive.yaw)
    ahead, left = place_m
    return drive.x + cosine * ahead - sine * left, drive.y + sine * ahead + cosine * left
