"""Surroundings: the map, the path ahead, and markers of the posts in the room."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.course.rover.camera import WALL_M
from studio.course.rover.room import MAP_CELL_M, POSTS_M, WALLS_M, occupancy
from studio.ros.client import DurabilityPolicy, Node, QoSProfile
from studio.ros.messages.geometry_msgs.msg import Point, PoseStamped, Vector3
from studio.ros.messages.nav_msgs.msg import OccupancyGrid, Path
from studio.ros.messages.std_msgs.msg import ColorRGBA
from studio.ros.messages.visualization_msgs.msg import Marker, MarkerArray

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.course.rover.drive import Drive
    from studio.course.rover.round_trip import RoundTrip
    from studio.ros.messages.builtin_interfaces.msg import Time

_ORANGE = ColorRGBA(r=0.87, g=0.47, b=0.24, a=1.0)
_GREY = ColorRGBA(r=0.6, g=0.63, b=0.68, a=1.0)
_WHITE = ColorRGBA(r=1.0, g=1.0, b=1.0, a=1.0)
_TITLE_M = 1.8


class Surroundings:
    """Publishes /map and /markers, which are kept for those who come late, and /plan."""

    def __init__(self, node: Node, trip: RoundTrip) -> None:
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._trip = trip
        self._plans = node.create_publisher(Path, "plan", 1)
        stamp = node.get_clock().now().to_msg()
        self._maps = node.create_publisher(OccupancyGrid, "map", kept)
        self._maps.publish(_map(stamp))
        self._markers = node.create_publisher(MarkerArray, "markers", kept)
        self._markers.publish(_markers())

    def publish(self, stamp: Time, drive: Drive) -> None:
        """Publish the path from here once around."""
        plan = Path()
        plan.header.stamp, plan.header.frame_id = stamp, "map"
        for x, y in self._trip.plan_from(drive.x, drive.y).tolist():
            pose = PoseStamped(header=plan.header)
            pose.pose.position.x, pose.pose.position.y = x, y
            plan.poses.append(pose)
        self._plans.publish(plan)


def _map(stamp: Time) -> OccupancyGrid:
    cells, x0_m, y0_m = occupancy()
    grid = OccupancyGrid(data=cells.ravel())
    grid.header.stamp, grid.header.frame_id = stamp, "map"
    grid.info.map_load_time, grid.info.resolution = stamp, MAP_CELL_M
    grid.info.height, grid.info.width = cells.shape
    grid.info.origin.position.x, grid.info.origin.position.y = x0_m, y0_m
    return grid


def _markers() -> MarkerArray:
    """Return markers that stay in their frame, without a stamp: sent once, they stay drawn."""
    walls = _marker("walls", 0, Marker.LINE_LIST, _GREY, (0.05, 0.0, 0.0))
    walls.points = list(_wall_edges())
    posts = [_post(number, *place) for number, place in enumerate(POSTS_M.tolist())]
    title = _marker("title", 0, Marker.TEXT_VIEW_FACING, _WHITE, (0.0, 0.0, 0.3))
    title.text, title.pose.position.z = "room of the rover", _TITLE_M
    return MarkerArray(markers=[walls, *posts, title])


def _post(number: int, x: float, y: float, radius_m: float) -> Marker:
    post = _marker("posts", number, Marker.CYLINDER, _ORANGE, (2 * radius_m, 2 * radius_m, WALL_M))
    place = post.pose.position
    place.x, place.y, place.z = x, y, WALL_M / 2
    return post


def _wall_edges() -> Iterable[Point]:
    for x0, y0, x1, y1 in WALLS_M.tolist():
        for z in (0.0, WALL_M):
            yield from (Point(x=x0, y=y0, z=z), Point(x=x1, y=y1, z=z))
        yield from (Point(x=x0, y=y0, z=0.0), Point(x=x0, y=y0, z=WALL_M))


def _marker(
    namespace: str, number: int, kind: int, color: ColorRGBA, scale: tuple[float, float, float]
) -> Marker:
    marker = Marker(ns=namespace, id=number, type=kind, action=Marker.ADD, color=color)
    marker.frame_locked = True
    marker.header.frame_id = "map"
    marker.scale = Vector3(x=scale[0], y=scale[1], z=scale[2])
    marker.pose.orientation.w = 1.0
    return marker
