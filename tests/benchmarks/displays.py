"""Displays: milliseconds from the bytes of a message to its Drawing, and the share of decoding."""

from __future__ import annotations

import io
import time
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image

from studio.displays.display import Limits
from studio.displays.image import ImageDisplay
from studio.displays.laser_scan import LaserScanDisplay
from studio.displays.map import MapDisplay
from studio.displays.point_cloud2 import PointCloud2Display
from studio.ros.types.library import TypeLibrary
from tests.benchmarks import displays_markers
from tests.benchmarks.report import Timings, judge, say
from tests.support.display_messages import received

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Display, Received
    from studio.displays.properties import Value

TYPES = TypeLibrary("jazzy")
RUNS = 40
_MILLION = Limits(points=1_000_000)
_POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("last", "<f4")])


def run() -> None:
    """Measure each display in turn."""
    say(f"{'decode and draw':<44}{'median':>10}{'p95':>10}{'decode':>10}{'share':>8}")
    scan = _measure("LaserScan, 1,080 beams", LaserScanDisplay, _scan(1080))
    cloud = cloud_message(300_000, "intensity")
    intensity = _measure("PointCloud2, 300,000, intensity", PointCloud2Display, cloud)
    flat: dict[str, Value] = {"Color Transformer": "FlatColor"}
    _measure("PointCloud2, 300,000, one colour", PointCloud2Display, cloud, values=flat)
    _measure("PointCloud2, 300,000, RGB8", PointCloud2Display, cloud_message(300_000, "rgb"))
    holes = cloud_message(300_000, "intensity", share_of_nan=0.3)
    broken = _measure("PointCloud2, 300,000, a third NaN", PointCloud2Display, holes)
    large = cloud_message(1_000_000, "intensity")
    _measure("PointCloud2, 1,000,000, all shown", PointCloud2Display, large, limits=_MILLION)
    _measure("PointCloud2, 1,000,000, 300,000 shown", PointCloud2Display, large)
    _measure("OccupancyGrid, 2,000 x 2,000, all new", MapDisplay, map_message(2000), fresh=True)
    _measure("Image, 1,920 x 1,080, rgb8", ImageDisplay, _image(1920, 1080))
    _measure("CompressedImage, 1,920 x 1,080, jpeg", ImageDisplay, _jpeg(1920, 1080))
    judge("LaserScan(1080): decode and draw", scan, at_most=0.5)
    judge("PointCloud2(300k): decode and draw", intensity, at_most=15)
    judge("PointCloud2(300k), a third NaN: decode and draw", broken, at_most=15)
    displays_markers.run()


def _measure(
    title: str,
    kind: type[Display],
    message: Received,
    *,
    values: dict[str, Value] | None = None,
    limits: Limits | None = None,
    fresh: bool = False,
) -> float:
    """Take and draw the message again and again; the median in ms."""
    display = kind(TYPES, values)
    display.limit(limits or Limits())
    whole, decode = Timings(title), Timings("decode")
    for _ in range(RUNS):
        if fresh:
            display.reset()
        with whole.measure():
            display.take(message)
            display.draw(time.time_ns())
        with decode.measure():
            display.decode(message)
    share = decode.median_ms / whole.median_ms
    figures = f"{whole.median_ms:10.3f}{whole.p95_ms:10.3f}{decode.median_ms:10.3f}{share:8.1%}"
    say(f"  {title:<42}{figures}")
    return whole.median_ms


def _scan(count: int) -> Received:
    ranges = np.random.default_rng(1).uniform(0.1, 11.0, count).astype(np.float32)
    fields = {
        "angle_min": -2.35, "angle_increment": 4.7 / count, "range_min": 0.2, "range_max": 10.0,
        "ranges": ranges, "intensities": ranges * 10,
    }  # fmt: skip
    return received("sensor_msgs/msg/LaserScan", fields)


def cloud_message(count: int, last: str, share_of_nan: float = 0.0) -> Received:
    """Points anywhere, each of four floats, of which the last has this name."""
    rng = np.random.default_rng(1)
    points = np.zeros(count, dtype=_POINT)
    for name in _POINT.names or ():
        points[name] = rng.uniform(-20, 20, count)
    points["x"][rng.uniform(size=count) < share_of_nan] = np.nan
    names = ("x", "y", "z", last)
    fields: list[dict[str, Any]] = [
        {"name": name, "offset": 4 * at, "datatype": 7, "count": 1} for at, name in enumerate(names)
    ]
    whole = {
        "height": 1, "width": count, "fields": fields, "point_step": 16, "row_step": 16 * count,
        "data": points.view(np.uint8),
    }  # fmt: skip
    return received("sensor_msgs/msg/PointCloud2", whole)


def map_message(edge: int) -> Received:
    """A square of cells, each of any value."""
    cells = np.random.default_rng(1).integers(-1, 101, edge * edge).astype(np.int8)
    info = {"width": edge, "height": edge, "resolution": 0.05}
    return received("nav_msgs/msg/OccupancyGrid", {"info": info, "data": cells})


def _image(width: int, height: int) -> Received:
    data = _pixels(width, height)
    size = {"width": width, "height": height, "step": 3 * width, "encoding": "rgb8"}
    return received("sensor_msgs/msg/Image", {**size, "data": data.ravel()})


def _jpeg(width: int, height: int) -> Received:
    packed = io.BytesIO()
    Image.fromarray(_pixels(width, height)).save(packed, "JPEG")
    fields = {"format": "jpeg", "data": packed.getvalue()}
    return received("sensor_msgs/msg/CompressedImage", fields)


def _pixels(width: int, height: int) -> NDArray[np.uint8]:
    """A slope of grey: noise would take longer to unpack than any picture."""
    row = np.linspace(0, 255, width).astype(np.uint8)
    return np.repeat(np.tile(row, (height, 1))[..., None], 3, axis=2)
