"""DepthCloud, beside a pinhole that is written out pixel by pixel."""

import io
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from numpy.typing import ArrayLike
from PIL import Image

from studio.displays.depth_cloud import DepthCloudDisplay
from studio.displays.display import Limits, Received
from studio.displays.drawing import Points
from studio.displays.properties import Value
from studio.errors import DisplayMessageError
from studio.tf.buffer import TransformBuffer
from tests.support.display_messages import HEADER, NOW_NS, STAMP_NS, TYPES, received
from tests.support.drawn import said
from tests.support.transforms import Told, columns

IMAGE, INFO = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
PACKED = "sensor_msgs/msg/CompressedImage"
FX, FY, CX, CY = 500.0, 510.0, 2.5, 1.25
K = [FX, 0.0, CX, 0.0, FY, CY, 0.0, 0.0, 1.0]
COLOURED: dict[str, Value] = {"Color Image Topic": "/rgb"}


def info(width: int = 4, height: int = 3, **fields: object) -> Received:
    return received(INFO, {"width": width, "height": height, "k": K, **fields})


def depth(
    pixels: ArrayLike, encoding: str = "32FC1", *, big: bool = False, **fields: object
) -> Received:
    kind = {"32FC1": "f4", "16UC1": "u2", "mono16": "u2"}[encoding]
    array = np.asarray(pixels).astype((">" if big else "<") + kind)
    height, width = array.shape
    whole = {
        "height": height, "width": width, "encoding": encoding, "is_bigendian": int(big),
        "step": width * array.itemsize, "data": array.tobytes(), **fields,
    }  # fmt: skip
    return received(IMAGE, whole)


def picture(pixels: ArrayLike, *, sec: int = 12, frame: str = "map") -> Received:
    array = np.asarray(pixels, np.uint8)
    height, width = array.shape[:2]
    header = {"frame_id": frame, "stamp": {"sec": sec, "nanosec": 0}}
    data = {"encoding": "rgb8", "step": 3 * width, "data": array.tobytes()}
    return received(IMAGE, {"header": header, "height": height, "width": width, **data})


def shown(display: DepthCloudDisplay) -> Points:
    (placed,) = display.draw(NOW_NS).values()
    assert (placed.frame, placed.stamp_ns) == ("map", STAMP_NS)
    shape = placed.shapes["points"]
    assert isinstance(shape, Points)
    return shape


def by_hand(pixels: list[list[float]]) -> list[list[float]]:
    """The points of a depth image, m, one after the other."""
    places: list[list[float]] = []
    for v, row in enumerate(pixels):
        for u, z in enumerate(row):
            if math.isfinite(z) and z > 0:
                places.append([(u - CX) * z / FX, (v - CY) * z / FY, z])
    return places


METRES = [[1.0, 2.0, math.nan, 0.5], [0.0, -1.0, math.inf, 4.0], [3.0, 1.5, 2.5, 8.0]]
MILLIMETRES = [[1000, 0, 65535, 1], [500, 250, 2000, 0], [1, 2, 3, 4]]


@pytest.mark.parametrize("big", [True, False])
def test_each_depth_is_where_the_pinhole_has_it(big: bool):
    display = DepthCloudDisplay(TYPES)
    display.take(info(), "camera_info")
    display.take(depth(METRES, big=big))
    assert_allclose(shown(display).positions, by_hand(METRES), rtol=1e-5)
    assert not display.statuses()


@pytest.mark.parametrize("encoding", ["16UC1", "mono16"])
def test_sixteen_bits_are_millimetres(encoding: str):
    display = DepthCloudDisplay(TYPES)
    display.take(info(), "camera_info")
    display.take(depth(MILLIMETRES, encoding))
    metres = np.array(MILLIMETRES) / 1000
    assert_allclose(shown(display).positions, by_hand(metres.tolist()), rtol=1e-5)


def test_a_packed_depth_image_is_the_same_cloud():
    file = io.BytesIO()
    Image.fromarray(np.array(MILLIMETRES, np.uint16)).save(file, "PNG")
    fields = {"format": "16UC1; compressedDepth png", "data": bytes(12) + file.getvalue()}
    display = DepthCloudDisplay(TYPES, {"Depth Map Transport Hint": "compressedDepth"})
    assert display.roles()[0].topic("/depth/image") == "/depth/image/compressedDepth"
    assert display.roles()[0].topic("/depth/image/compressedDepth").count("compressedDepth") == 1
    display.take(info(), "camera_info")
    display.take(received(PACKED, fields))
    metres = (np.array(MILLIMETRES) / 1000).tolist()
    assert_allclose(shown(display).positions, by_hand(metres), rtol=1e-5)


def test_of_a_binned_image_and_a_region_the_pinhole_is_that_of_the_image():
    display = DepthCloudDisplay(TYPES)
    roi = {"x_offset": 2, "y_offset": 0, "width": 8, "height": 6}
    display.take(info(16, 12, roi=roi), "camera_info")
    display.take(depth([[1.0, 1.0, 1.0, 1.0]] * 3))
    first = shown(display).positions[0]
    assert_allclose(first, [-(CX - 2) / FX, -CY / FY, 1.0], rtol=1e-5)


def test_the_calibration_may_come_after_the_image_and_is_said_until_it_does():
    display = DepthCloudDisplay(TYPES)
    display.take(depth(METRES))
    assert not display.draw(NOW_NS)
    assert said(display) == [("error", "no_camera_info")]
    display.take(received(INFO, {"width": 4, "height": 3}), "camera_info")
    assert said(display) == [("error", "no_camera_info")]
    assert "no focal length" in display.statuses()[0].sentence
    display.take(info(), "camera_info")
    assert len(shown(display).positions) == len(by_hand(METRES))
    assert not display.statuses()


def test_colours_are_those_of_the_pixel_at_the_same_part_of_a_picture_of_another_size():
    display = DepthCloudDisplay(TYPES, COLOURED)
    assert [one.topic("/depth/image") for one in display.roles()] == [
        "/depth/image", "/depth/camera_info", "/rgb",
    ]  # fmt: skip
    display.take(info(), "camera_info")
    pixels = np.arange(8 * 6 * 3).reshape(6, 8, 3)
    display.take(picture(pixels), "color")
    display.take(depth([[1.0, 1.0, 0.0, 1.0]] * 3))
    expected = [pixels[2 * v, 2 * u] for v in range(3) for u in (0, 1, 3)]
    assert_array_equal(shown(display).colors, expected)


def test_the_picture_nearest_in_time_gives_the_colours_whichever_comes_last():
    red, green = [[[255, 0, 0]]], [[[0, 255, 0]]]
    display = DepthCloudDisplay(TYPES, COLOURED)
    display.take(info(1, 1), "camera_info")
    display.take(depth([[1.0]]))
    display.take(picture(red, sec=900), "color")
    assert said(display) == [("warn", "no_picture")]
    display.take(picture(green), "color")
    assert_array_equal(shown(display).colors, [[0, 255, 0]])
    display.take(picture(red, sec=901), "color")
    assert_array_equal(shown(display).colors, [[0, 255, 0]])
    assert not display.statuses()


def test_a_picture_of_another_frame_is_drawn_and_said():
    display = DepthCloudDisplay(TYPES, COLOURED)
    display.take(info(1, 1), "camera_info")
    display.take(depth([[1.0]]))
    display.take(picture([[[1, 2, 3]]], frame="elsewhere"), "color")
    assert_array_equal(shown(display).colors, [[1, 2, 3]])
    assert [one.level for one in display.statuses()] == ["warn"]


def test_that_a_picture_is_of_another_frame_is_said_of_the_first_depth_image_too():
    display = DepthCloudDisplay(TYPES, COLOURED)
    display.take(info(1, 1), "camera_info")
    display.take(picture([[[1, 2, 3]]], frame="elsewhere"), "color")
    display.take(depth([[1.0]]))
    assert [one.level for one in display.statuses()] == ["warn"]


def test_a_point_is_as_large_as_its_pixel_or_as_was_set():
    display = DepthCloudDisplay(TYPES)
    display.take(info(), "camera_info")
    display.take(depth(METRES))
    assert (shown(display).size_by_z, shown(display).size_m) == (True, 1 / FX)
    display.set("Auto Size/Auto Size Factor", 3.0)
    assert shown(display).size_m == 3 / FX
    display.set("Auto Size", value=False)
    assert (shown(display).size_by_z, shown(display).size_m) == (False, 0.01)


def test_what_is_hidden_stays_until_the_camera_moves():
    display = DepthCloudDisplay(TYPES, {"Occlusion Compensation": True})
    buffer = TransformBuffer()

    def see(x: float) -> None:
        buffer.put(columns(Told("world", "map", STAMP_NS, (x, 0.0, 0.0))), static=False)
        display.see(buffer.all_in("world"))

    display.take(info(1, 1), "camera_info")
    display.take(depth([[3.0]]))
    see(0.0)
    display.take(depth([[3.0]]))
    see(0.001)
    display.take(depth([[1.0]]))
    assert sorted(shown(display).positions[:, 2].tolist()) == [1.0, 3.0]
    see(0.5)
    display.take(depth([[1.0]]))
    assert shown(display).positions[:, 2].tolist() == [1.0]


def test_of_too_many_points_as_many_as_the_limit_allows_are_drawn():
    display = DepthCloudDisplay(TYPES)
    display.limit(Limits(points=1000))
    display.take(info(200, 100), "camera_info")
    display.take(depth(np.ones((100, 200))))
    assert len(shown(display).positions) == 1000
    assert said(display) == [("ok", "thinned")]


def test_a_picture_without_depths_is_refused_and_named():
    display = DepthCloudDisplay(TYPES)
    display.take(info(), "camera_info")
    with pytest.raises(DisplayMessageError, match='no depths but "rgb8"'):
        display.take(received(IMAGE, {
            "header": HEADER, "height": 1, "width": 1, "step": 3, "encoding": "rgb8",
            "data": bytes(3),
        }))  # fmt: skip


def test_nothing_measured_and_no_pixels_are_said():
    display = DepthCloudDisplay(TYPES)
    display.take(info(1, 1), "camera_info")
    display.take(depth([[0.0]]))
    assert said(display) == [("warn", "not_finite")]


def test_the_queue_and_the_reliability_are_those_of_the_properties():
    display = DepthCloudDisplay(TYPES, {"Queue Size": 9, "Reliability Policy": "Reliable"})
    assert (display.roles()[0].depth, display.roles()[0].chosen_reliable) == (9, True)
