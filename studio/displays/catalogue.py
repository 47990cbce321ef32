"""Catalogue: all displays, by RViz's names and by the messages that they draw."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.displays.axes import AxesDisplay
from studio.displays.camera import CameraDisplay
from studio.displays.depth_cloud import DepthCloudDisplay
from studio.displays.effort import EffortDisplay
from studio.displays.grid import GridDisplay
from studio.displays.grid_cells import GridCellsDisplay
from studio.displays.image import ImageDisplay
from studio.displays.imu import ImuDisplay
from studio.displays.interactive_markers import InteractiveMarkersDisplay
from studio.displays.laser_scan import LaserScanDisplay
from studio.displays.map import MapDisplay
from studio.displays.markers.display import MarkerArrayDisplay, MarkerDisplay
from studio.displays.measurement import (
    FluidPressureDisplay,
    IlluminanceDisplay,
    RelativeHumidityDisplay,
    TemperatureDisplay,
)
from studio.displays.odometry import OdometryDisplay
from studio.displays.path import PathDisplay
from studio.displays.point import PointStampedDisplay
from studio.displays.point_cloud import PointCloudDisplay
from studio.displays.point_cloud2 import PointCloud2Display
from studio.displays.polygon import PolygonDisplay
from studio.displays.pose import PoseDisplay
from studio.displays.pose_array import PoseArrayDisplay
from studio.displays.pose_with_covariance import PoseWithCovarianceDisplay
from studio.displays.range import RangeDisplay
from studio.displays.robot_model import RobotModelDisplay
from studio.displays.tf import TfDisplay
from studio.displays.trajectory import DisplayTrajectoryDisplay, JointTrajectoryDisplay
from studio.displays.vectors import AccelDisplay, TwistDisplay, WrenchDisplay
from studio.errors import DisplayError

if TYPE_CHECKING:
    from studio.displays.display import Display

DISPLAYS: Final[tuple[type[Display], ...]] = (
    AccelDisplay,
    AxesDisplay,
    DisplayTrajectoryDisplay,
    EffortDisplay,
    FluidPressureDisplay,
    GridCellsDisplay,
    GridDisplay,
    IlluminanceDisplay,
    ImageDisplay,
    CameraDisplay,
    DepthCloudDisplay,
    ImuDisplay,
    InteractiveMarkersDisplay,
    JointTrajectoryDisplay,
    LaserScanDisplay,
    MapDisplay,
    MarkerArrayDisplay,
    MarkerDisplay,
    OdometryDisplay,
    PathDisplay,
    PointCloud2Display,
    PointCloudDisplay,
    PointStampedDisplay,
    PolygonDisplay,
    PoseArrayDisplay,
    PoseDisplay,
    PoseWithCovarianceDisplay,
    RangeDisplay,
    RelativeHumidityDisplay,
    RobotModelDisplay,
    TemperatureDisplay,
    TfDisplay,
    TwistDisplay,
    WrenchDisplay,
)
"""One row each. Of two that draw the same messages, the one that fits them best comes first."""

_BY_KIND: Final = {one.KIND: one for one in DISPLAYS}


def display_of_kind(kind: str) -> type[Display]:
    """Return the display of an RViz name, with or without its package, as `rviz_imu_plugin/Imu`.

    Raises:
        DisplayError: There is none.
    """
    found = _BY_KIND.get(kind.rpartition("/")[2])
    if found is None:
        raise DisplayError(
            f'There is no display "{kind[:60]}" here: choose one of {", ".join(sorted(_BY_KIND))}.'
        )
    return found


def displays_of_type(type_name: str, topic: str = "") -> tuple[type[Display], ...]:
    """Return the displays whose main topic has messages of a type, the best first.

    A std_msgs/String may be anything: a display of strings is for topics that are named like its
    `FIRST_TOPIC`.
    """
    return tuple(
        one
        for one in DISPLAYS
        if type_name in _types_of(one) and topic.endswith(one.FIRST_TOPIC.removeprefix("/"))
    )


def _types_of(display: type[Display]) -> tuple[str, ...]:
    """Return the types that a display draws, also if others receive them for it."""
    return display.TOPICS[0].types if display.TOPICS else display.OF_TYPES
