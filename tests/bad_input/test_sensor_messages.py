"""Scans, clouds, maps and pictures whose bytes were changed anywhere."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from studio.displays.display import Limits
from studio.displays.drawing import Points
from studio.displays.image import ImageDisplay
from studio.displays.laser_scan import LaserScanDisplay
from studio.displays.map import MapDisplay
from studio.displays.point_cloud2 import PointCloud2Display
from studio.errors import StudioError
from tests.support.clouds import RGB, Layout, cloud
from tests.support.display_messages import NOW_NS, TYPES, received

if TYPE_CHECKING:
    from studio.displays.display import Display, Received

POINTS = [[(1.0, 2.0, 3.0, 4.0)] * 4] * 3
ODD = Layout((("z", 1, 4), ("x", 3, 8), ("y", 11, 1), ("rgb", 12, 6)), 19, 3, big=True)
ODD_POINTS = [[(1, 2.0, 3, 4)] * 4] * 3
PICTURE = io.BytesIO()
Image.fromarray(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)).save(PICTURE, "PNG")


def image(encoding: str, pixel_bytes: int) -> Received:
    size = {"width": 4, "height": 4, "step": 4 * pixel_bytes, "data": bytes(24 * pixel_bytes)}
    return received("sensor_msgs/msg/Image", {"encoding": encoding, **size})


MESSAGES: dict[str, tuple[type[Display], Received]] = {
    "scan": (
        LaserScanDisplay,
        received(
            "sensor_msgs/msg/LaserScan",
            {
                "angle_increment": 0.1,
                "range_max": 10.0,
                "ranges": [1.0] * 9,
                "intensities": [2] * 9,
            },
        ),
    ),
    "cloud": (PointCloud2Display, cloud(RGB, POINTS)),
    "odd cloud": (PointCloud2Display, cloud(ODD, ODD_POINTS, little=False)),
    "map": (
        MapDisplay,
        received(
            "nav_msgs/msg/OccupancyGrid",
            {"info": {"resolution": 0.1, "width": 4, "height": 3}, "data": [1] * 12},
        ),
    ),
    "rgb8": (ImageDisplay, image("rgb8", 3)),
    "32FC1": (ImageDisplay, image("32FC1", 4)),
    "uyvy": (ImageDisplay, image("uyvy", 2)),
    "nv12": (ImageDisplay, image("nv12", 1)),
    "bayer_grbg16": (ImageDisplay, image("bayer_grbg16", 2)),
    "png": (
        ImageDisplay,
        received("sensor_msgs/msg/CompressedImage", {"format": "png", "data": PICTURE.getvalue()}),
    ),
}
FOUR_BYTES = st.sampled_from(
    [b"\xff" * 4, bytes(4), b"\x00\x00\x80\x7f", b"\x00\x00\xc0\x7f", b"\xff\xff\x7f\x7f"]
) | st.binary(min_size=4, max_size=4)
CHANGES = st.lists(st.tuples(st.floats(0, 1), FOUR_BYTES | st.binary(max_size=1)), max_size=4)


@pytest.mark.parametrize("name", MESSAGES)
@settings(max_examples=60)
@given(changes=CHANGES, cut=st.none() | st.floats(0, 1))
def test_whatever_comes_is_drawn_or_refused_with_a_sentence(
    name: str, changes: list[tuple[float, bytes]], cut: float | None
):
    kind, message = MESSAGES[name]
    data = bytearray(message.cdr)
    for share, part in changes:
        at = 4 + int(share * (len(data) - 4 - len(part)))
        data[at : at + len(part)] = part
    if cut is not None:
        del data[int(cut * len(data)) :]
    display = kind(TYPES)
    display.limit(Limits(points=5, cells=5, pixels=5))
    sentence = "."
    try:
        display.take(message._replace(cdr=bytes(data)))
    except StudioError as error:
        sentence = str(error)
    assert sentence.endswith(".")
    for placed in display.draw(NOW_NS).values():
        for shape in placed.shapes.values():
            assert not isinstance(shape, Points) or np.isfinite(shape.positions).all()
    assert all(status.sentence for status in display.statuses())
