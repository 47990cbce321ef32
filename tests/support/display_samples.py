"""What real nodes tell, a sample for each display: messages as a robot of half a metre has them."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image

from tests.support.display_messages import TYPES, point, pose

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.properties import Value

Fields = dict[str, Any]
BASE = "base_link"
_CAMERA = "camera"
_LEVEL = (1.0, 0.0, 0.0, 0.0)


def about_z(angle_rad: float) -> tuple[float, float, float, float]:
    """A turn to the left."""
    return (math.cos(angle_rad / 2), 0.0, 0.0, math.sin(angle_rad / 2))


FRAMES: tuple[
    tuple[str, str, tuple[float, float, float], tuple[float, float, float, float]], ...
] = (
    ("odom", "dock", (-0.8, -0.6, 0.0), _LEVEL),
    ("odom", "base_footprint", (0.0, 0.0, 0.0), _LEVEL),
    (BASE, "laser", (0.25, 0.0, 0.2), about_z(0.4)),
    (BASE, "imu", (0.0, 0.0, 0.6), _LEVEL),
    (BASE, "sensor", (-0.2, 0.3, 0.9), about_z(1.2)),
    (BASE, _CAMERA, (0.3, 0.0, 0.5), (0.5, -0.5, 0.5, -0.5)),
)
"""Parent, child, and where the child is: x, y, z and w, x, y, z."""


@dataclass(frozen=True)
class Sample:
    """One display and what it listens to.

    Attributes:
        name: Of the picture.
        kind: Of the display.
        type_name: Of the messages; empty for a display that listens to nothing.
        fields: Of a message; its header is added.
        values: Properties of the display.
        frame: Of the header.
        beside: Other topics that are told: their type and fields by their name.
    """

    name: str
    kind: str
    type_name: str = ""
    fields: Fields = field(default_factory=dict[str, Any])
    values: Mapping[str, Value] = field(default_factory=dict[str, "Value"])
    frame: str = BASE
    beside: Mapping[str, tuple[str, Fields]] = field(default_factory=dict[str, tuple[str, Fields]])

    @property
    def topic(self) -> str:
        """Which nobody else uses."""
        return f"/{self.name}/told" if self.type_name else ""

    def messages(self) -> dict[str, tuple[str, Fields]]:
        """Type and fields of all that is told by the topics, what is beside the main one first."""
        main = {self.topic: (self.type_name, self.fields)} if self.type_name else {}
        return {**self.beside, **main}


def headed(type_name: str, fields: Fields, frame: str, stamp: Fields) -> Fields:
    """Fields with a header, where there is one; what they say of it themselves holds."""
    if not hasattr(TYPES.message(type_name)(), "header"):
        return fields
    header = {"frame_id": frame, "stamp": stamp}
    return {**fields, "header": header | fields.get("header", {})}


def _rgba(r: float, g: float, b: float, a: float = 1.0) -> Fields:
    return {"r": r, "g": g, "b": b, "a": a}


def _circle(count: int, radius_m: float = 1.0) -> list[tuple[float, float, float]]:
    """Places around the robot, with the heading along the circle."""
    angles = np.linspace(0, 2 * math.pi, count, endpoint=False)
    return [(radius_m * math.cos(a), radius_m * math.sin(a), a + math.pi / 2) for a in angles]


def _poses(count: int) -> list[Fields]:
    return [pose((x, y, 0.05), about_z(turn)) for x, y, turn in _circle(count)]


def _stamped(poses: list[Fields]) -> list[Fields]:
    return [{"header": {"frame_id": BASE}, "pose": one} for one in poses]


def _covariance() -> list[float]:
    diagonal = (0.04, 0.01, 0.02, 0.02, 0.02, 0.12)
    return np.diag(diagonal).reshape(-1).tolist()


def _scan() -> Fields:
    """A room of 3 m by 4 m, with noise that is always the same."""
    angles = np.linspace(-math.pi, math.pi, 720, endpoint=False)
    with np.errstate(divide="ignore"):
        walls = np.minimum(1.5 / np.abs(np.cos(angles)), 2.0 / np.abs(np.sin(angles)))
    noise = np.random.default_rng(1).normal(0, 0.008, len(angles))
    return {
        "angle_min": -math.pi,
        "angle_max": math.pi,
        "angle_increment": 2 * math.pi / len(angles),
        "range_min": 0.1,
        "range_max": 12.0,
        "ranges": (walls + noise).tolist(),
        "intensities": (100 + 100 * np.cos(3 * angles)).tolist(),
    }


def _cloud(*, coloured: bool) -> Fields:
    """A hilly floor; with colours or with intensities."""
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(-1.5, 1.5, 130)] * 2))
    z = 0.2 * np.sin(3 * x) * np.cos(2 * y) - 0.1
    rows = np.stack([x, y, z, np.hypot(x, y)], axis=1).astype("<f4")
    if coloured:
        red, green, blue = (np.uint32(128 + 127 * np.sin(one)) for one in (2 * x, 2 * y, x + y))
        rows[:, 3] = (red << np.uint32(16) | green << np.uint32(8) | blue).view("<f4")
    names = ("x", "y", "z", "rgb" if coloured else "intensity")
    return {
        "height": 1,
        "width": len(rows),
        "fields": [
            {"name": name, "offset": 4 * at, "datatype": 7, "count": 1}
            for at, name in enumerate(names)
        ],
        "point_step": 16,
        "row_step": 16 * len(rows),
        "data": rows.tobytes(),
        "is_dense": True,
    }


def _channels() -> Fields:
    """A spiral, as an old driver sends it."""
    angles = np.linspace(0, 6 * math.pi, 900)
    rows = np.stack([np.cos(angles), np.sin(angles), angles / 20], axis=1)
    return {
        "points": [point(*row) for row in rows.tolist()],
        "channels": [{"name": "intensity", "values": (50 * angles).tolist()}],
    }


def _map() -> Fields:
    """A room with a wall, a round obstacle with a slope around it, and a corner nobody saw."""
    x, y = np.meshgrid(np.linspace(-1.5, 1.5, 120), np.linspace(-1.5, 1.5, 120))
    cells = np.clip(110 - 160 * np.hypot(x - 0.8, y + 0.7), 0, 99)
    cells[np.hypot(x - 0.8, y + 0.7) < 0.15] = 100
    cells[(np.abs(x) > 1.42) | (np.abs(y) > 1.42)] = 100
    cells[(x < -0.6) & (y > 0.7)] = -1
    return {
        "info": {
            "resolution": 3.0 / 120,
            "width": 120,
            "height": 120,
            "origin": pose((-1.5, -1.5, 0.0)),
        },
        "data": cells.astype(np.int8).ravel().tolist(),
    }


def _pixels() -> NDArray[np.uint8]:
    """Stripes that go over into each other, and a ball in front."""
    x, y = np.meshgrid(np.linspace(0, 1, 160), np.linspace(0, 1, 120))
    pixels = np.stack([255 * x, 255 * y, 128 + 127 * np.sin(20 * x)], axis=2)
    pixels[np.hypot((x - 0.5) * 4 / 3, y - 0.5) < 0.2] = (240, 200, 40)
    return pixels.astype(np.uint8)


def _picture() -> Fields:
    data = _pixels().tobytes()
    return {"height": 120, "width": 160, "encoding": "rgb8", "step": 480, "data": data}


def _compressed() -> Fields:
    file = io.BytesIO()
    Image.fromarray(_pixels()).save(file, "PNG")
    return {"format": "rgb8; png compressed bgr8", "data": file.getvalue()}


def _camera() -> Fields:
    k = [140.0, 0.0, 80.0, 0.0, 140.0, 60.0, 0.0, 0.0, 1.0]
    p = [140.0, 0.0, 80.0, 0.0, 0.0, 140.0, 60.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    return {"header": {"frame_id": _CAMERA}, "height": 120, "width": 160, "k": k, "p": p}


def _depths(encoding: str) -> Fields:
    """A wall with a step in it, as a depth camera sees it: in mm, or in m."""
    x, y = np.meshgrid(np.linspace(-1, 1, 160), np.linspace(-1, 1, 120))
    depths_m = np.where(np.hypot(x, y) < 0.5, 0.8, 1.2 + 0.2 * x)
    if encoding == "16UC1":
        data = (1000 * depths_m).astype("<u2").tobytes()
        return {"height": 120, "width": 160, "encoding": "16UC1", "step": 320, "data": data}
    steps = (1000 * depths_m).astype("<u2")
    file = io.BytesIO()
    Image.fromarray(steps).save(file, "PNG")
    return {"format": "16UC1; compressedDepth png", "data": bytes(12) + file.getvalue()}


_WAVE: Fields = {
    "joint_names": ["arm_turret_joint", "arm_shoulder_joint", "arm_elbow_joint"],
    "points": [
        {"positions": [0.5 * at - 1.0, 0.3 * at, -0.2 * at],
         "time_from_start": {"sec": at, "nanosec": 500_000_000}}
        for at in range(5)
    ],
}  # fmt: skip


def _marker(kind: int, at: int, **fields: Any) -> Fields:  # noqa: ANN401
    """One of a row of markers, each in a place of its own."""
    row, column = divmod(at, 4)
    colours = ((0.9, 0.3, 0.2), (0.2, 0.7, 0.3), (0.25, 0.45, 0.95), (0.95, 0.75, 0.1))
    return {
        "header": {"frame_id": BASE},
        "ns": "samples",
        "id": at,
        "type": kind,
        "pose": pose((0.8 * column - 1.2, 0.8 - 0.8 * row, 0.2)),
        "scale": point(0.3, 0.3, 0.3),
        "color": _rgba(*colours[at % 4]),
        **fields,
    }


def _markers() -> Fields:
    """All kinds of markers that need no file."""
    wave = [point(0.02 * at - 0.2, 0.1 * math.sin(at / 2), 0.0) for at in range(20)]
    corners = [(-0.2, -0.2, 0.0), (0.2, -0.2, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, 0.3)]
    faces = [corners[at] for at in (0, 1, 3, 1, 2, 3, 2, 0, 3)]
    return {
        "markers": [
            _marker(0, 0, scale=point(0.5, 0.06, 0.06)),
            _marker(1, 1),
            _marker(2, 2),
            _marker(3, 3, color=_rgba(0.2, 0.6, 0.9, 0.5)),
            _marker(4, 4, points=wave, scale=point(0.03, 0.0, 0.0)),
            _marker(5, 5, points=wave, scale=point(0.02, 0.0, 0.0)),
            _marker(6, 6, points=wave[::4], scale=point(0.06, 0.06, 0.06)),
            _marker(7, 7, points=wave[::4], scale=point(0.06, 0.06, 0.06)),
            _marker(8, 8, points=wave, scale=point(0.03, 0.03, 0.0)),
            _marker(9, 9, text="Docking station", scale=point(0.0, 0.0, 0.15)),
            _marker(
                11, 10, scale=point(1, 1, 1), points=[point(*one) for one in faces],
                colors=[_rgba(1, 0, 0), _rgba(0, 1, 0), _rgba(0, 0, 1)] * 3,
            ),
            _marker(0, 11, points=[point(0, 0, 0), point(0.2, 0.2, 0.3)],
                    scale=point(0.05, 0.1, 0.1)),
        ]
    }  # fmt: skip


_ARM = """<robot name="arm"><link name="base_link"/><link name="sensor"/>
  <joint name="turn" type="revolute"><parent link="base_link"/><child link="sensor"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="10" velocity="1"/></joint></robot>"""
_CRANE = """<robot name="crane"><material name="orange"><color rgba="0.95 0.5 0.1 1"/></material>
  <link name="laser"><visual><geometry><box size="0.3 0.3 0.1"/></geometry></visual></link>
  <link name="sensor"><visual><geometry><sphere radius="0.12"/></geometry>
    <material name="orange"/></visual></link>
  <joint name="jib" type="fixed"><parent link="laser"/><child link="sensor"/></joint></robot>"""
_IMU: Fields = {
    "orientation": {"x": 0.1, "y": 0.15, "z": 0.25, "w": 0.95},
    "angular_velocity": point(0.3, 0.2, 0.8),
    "linear_acceleration": point(0.4, 0.2, 1.0),
}
_STAR = [point(*at) for at in [(0.9, 0, 0), (0.3, 0.2, 0), (0, 0.9, 0), (-0.6, 0, 0), (0, -0.7, 0)]]

SAMPLES: tuple[Sample, ...] = (
    Sample("grid", "Grid"),
    Sample("axes", "Axes", values={"Length": 0.6, "Radius": 0.03}),
    Sample("tf", "TF", values={"Marker Scale": 0.6}),
    Sample(
        "handles", "InteractiveMarkers", values={"Interactive Markers Namespace": "/handles/told"}
    ),
    Sample("laser_scan", "LaserScan", "sensor_msgs/msg/LaserScan", _scan(),
           {"Size (m)": 0.03}, frame="laser"),
    Sample("cloud_rgb", "PointCloud2", "sensor_msgs/msg/PointCloud2", _cloud(coloured=True)),
    Sample("cloud_intensity", "PointCloud2", "sensor_msgs/msg/PointCloud2",
           _cloud(coloured=False), {"Size (m)": 0.02}),
    Sample("cloud_boxes", "PointCloud2", "sensor_msgs/msg/PointCloud2", _cloud(coloured=True),
           {"Style": "Boxes", "Size (m)": 0.015}),
    Sample("cloud_spheres", "PointCloud2", "sensor_msgs/msg/PointCloud2", _cloud(coloured=True),
           {"Style": "Spheres", "Size (m)": 0.015}),
    Sample("cloud_pixels", "PointCloud2", "sensor_msgs/msg/PointCloud2", _cloud(coloured=True),
           {"Style": "Points"}),
    Sample("point_cloud", "PointCloud", "sensor_msgs/msg/PointCloud", _channels(),
           {"Size (m)": 0.02}),
    Sample("robot_model", "RobotModel", "std_msgs/msg/String", {"data": _CRANE}),
    Sample("cloud_flat", "PointCloud2", "sensor_msgs/msg/PointCloud2", _cloud(coloured=False),
           {"Color Transformer": "FlatColor", "Alpha": 0.4}),
    Sample("imu", "Imu", "sensor_msgs/msg/Imu", _IMU,
           {"Box properties/Enable box": True, "Box properties/x_scale": 0.3,
            "Box properties/y_scale": 0.2, "Box properties/z_scale": 0.1,
            "Acceleration properties/Enable acceleration": True,
            "Angular velocity properties/Enable angular velocity": True}, frame="imu"),
    Sample("odometry", "Odometry", "nav_msgs/msg/Odometry",
           {"child_frame_id": BASE,
            "pose": {"pose": pose((0.3, 0.2, 0.0), about_z(0.5)), "covariance": _covariance()}}),
    Sample("path", "Path", "nav_msgs/msg/Path", {"poses": _stamped(_poses(40))}),
    Sample("path_wide", "Path", "nav_msgs/msg/Path", {"poses": _stamped(_poses(12))},
           {"Line Style": "Billboards", "Pose Style": "Axes"}),
    Sample("pose", "Pose", "geometry_msgs/msg/PoseStamped",
           {"pose": pose((0.4, 0.3, 0.3), about_z(0.8))}),
    Sample("pose_axes", "Pose", "geometry_msgs/msg/PoseStamped",
           {"pose": pose((0.4, 0.3, 0.3), about_z(0.8))}, {"Shape": "Axes"}),
    Sample("pose_array", "PoseArray", "geometry_msgs/msg/PoseArray", {"poses": _poses(60)}),
    Sample("pose_covariance", "PoseWithCovariance",
           "geometry_msgs/msg/PoseWithCovarianceStamped",
           {"pose": {"pose": pose((0.2, 0.2, 0.1), about_z(0.6)),
                     "covariance": _covariance()}}),
    Sample("point", "PointStamped", "geometry_msgs/msg/PointStamped",
           {"point": point(0.5, 0.4, 0.4)}),
    Sample("polygon", "Polygon", "geometry_msgs/msg/PolygonStamped",
           {"polygon": {"points": _STAR}}),
    Sample("grid_cells", "GridCells", "nav_msgs/msg/GridCells",
           {"cell_width": 0.1, "cell_height": 0.1,
            "cells": [point(round(x, 1), round(y, 1), 0.0) for x, y, _ in _circle(48)]}),
    Sample("map", "Map", "nav_msgs/msg/OccupancyGrid", _map()),
    Sample("map_costmap", "Map", "nav_msgs/msg/OccupancyGrid", _map(),
           {"Color Scheme": "costmap"}),
    Sample("map_raw", "Map", "nav_msgs/msg/OccupancyGrid", _map(),
           {"Color Scheme": "raw", "Alpha": 1.0}),
    Sample("marker", "Marker", "visualization_msgs/msg/Marker", _marker(1, 2)),
    Sample("marker_array", "MarkerArray", "visualization_msgs/msg/MarkerArray", _markers()),
    Sample("range", "Range", "sensor_msgs/msg/Range",
           {"field_of_view": 0.5, "min_range": 0.05, "max_range": 3.0, "range": 1.2}),
    Sample("image", "Image", "sensor_msgs/msg/Image", _picture(), frame=_CAMERA,
           beside={"/image/camera_info": ("sensor_msgs/msg/CameraInfo", _camera())}),
    Sample("packed", "Image", "sensor_msgs/msg/CompressedImage", _compressed(), frame=_CAMERA,
           beside={"/packed/camera_info": ("sensor_msgs/msg/CameraInfo", _camera())}),
    Sample("depth_cloud", "DepthCloud", "sensor_msgs/msg/Image", _depths("16UC1"),
           {"Color Image Topic": "/depth_cloud/color"}, frame=_CAMERA,
           beside={"/depth_cloud/camera_info": ("sensor_msgs/msg/CameraInfo", _camera()),
                   "/depth_cloud/color": ("sensor_msgs/msg/Image", _picture())}),
    Sample("depth_packed", "DepthCloud", "sensor_msgs/msg/CompressedImage", _depths("png"),
           {"Axis": "X"}, frame=_CAMERA,
           beside={"/depth_packed/camera_info": ("sensor_msgs/msg/CameraInfo", _camera())}),
    Sample("joint_trajectory", "JointTrajectory", "trajectory_msgs/msg/JointTrajectory", _WAVE,
           {"Show Trail": True, "Color Enabled": True}),
    Sample("display_trajectory", "DisplayTrajectory", "moveit_msgs/msg/DisplayTrajectory",
           {"model_id": "rover", "trajectory": [{"joint_trajectory": _WAVE}]},
           {"Pause": True, "Pause/Place": 0.5}),
    Sample("camera", "Camera", "sensor_msgs/msg/Image", _picture(), frame=_CAMERA,
           beside={"/camera/camera_info": ("sensor_msgs/msg/CameraInfo", _camera())}),
    Sample("camera_packed", "Camera", "sensor_msgs/msg/CompressedImage", _compressed(),
           frame=_CAMERA,
           beside={"/camera_packed/camera_info": ("sensor_msgs/msg/CameraInfo", _camera())}),
    Sample("wrench", "Wrench", "geometry_msgs/msg/WrenchStamped",
           {"wrench": {"force": point(0.5, 0.2, 0.6), "torque": point(0.0, 0.3, 0.4)}}),
    Sample("twist", "TwistStamped", "geometry_msgs/msg/TwistStamped",
           {"twist": {"linear": point(0.8, 0.1, 0.0), "angular": point(0.0, 0.0, 0.6)}}),
    Sample("accel", "AccelStamped", "geometry_msgs/msg/AccelStamped",
           {"accel": {"linear": point(0.5, 0.3, 0.2), "angular": point(0.2, 0.0, 0.5)}}),
    Sample("effort", "Effort", "sensor_msgs/msg/JointState",
           {"name": ["turn"], "effort": [2.0]},
           beside={"/effort/robot_description": ("std_msgs/msg/String", {"data": _ARM})}),
    Sample("temperature", "Temperature", "sensor_msgs/msg/Temperature",
           {"temperature": 42.0}, {"Size (m)": 0.15}, frame="sensor"),
    Sample("pressure", "FluidPressure", "sensor_msgs/msg/FluidPressure",
           {"fluid_pressure": 101_300.0}, {"Size (m)": 0.15}, frame="sensor"),
    Sample("illuminance", "Illuminance", "sensor_msgs/msg/Illuminance",
           {"illuminance": 600.0}, {"Size (m)": 0.15}, frame="sensor"),
    Sample("humidity", "RelativeHumidity", "sensor_msgs/msg/RelativeHumidity",
           {"relative_humidity": 0.4}, {"Size (m)": 0.15}, frame="sensor"),
)  # fmt: skip
