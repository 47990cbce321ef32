from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from numpy.typing import NDArray

from studio.displays.image_encodings import read_image, step_for
from studio.errors import DisplayMessageError
from studio.ros.cdr import codec_of
from tests.support.display_messages import TYPES, received

IMAGE = "sensor_msgs/msg/Image"
ALL = 1_000_000
RGB = [[[250, 20, 10], [1, 2, 3]], [[0, 255, 0], [7, 8, 9]]]


def image(encoding: str, pixels: NDArray[Any], padding: int = 0, **fields: Any) -> Any:  # noqa: ANN401
    """A message of rows of numbers, each with as many bytes behind it that mean nothing."""
    rows = [row.tobytes() + b"\xaa" * padding for row in pixels]
    size = {"height": len(rows), "width": pixels.shape[1], "step": len(rows[0]) if rows else 0}
    whole = {"encoding": encoding, "data": b"".join(rows), **size, **fields}
    return codec_of(TYPES.message(IMAGE)).decode(received(IMAGE, whole).cdr)


@pytest.mark.parametrize("padding", [0, 3])
@pytest.mark.parametrize(
    ("encoding", "order"),
    [("rgb8", "rgb"), ("bgr8", "bgr"), ("rgba8", "rgba"), ("bgra8", "bgra"), ("8UC3", "bgr"),
     ("8UC4", "bgra")],
)  # fmt: skip
def test_channels_of_bytes_come_out_red_green_and_blue(encoding: str, order: str, padding: int):
    sent = np.full((2, 2, len(order)), 77, dtype=np.uint8)
    for at, letter in enumerate("rgb"):
        sent[..., order.index(letter)] = np.array(RGB)[..., at]
    assert_array_equal(read_image(image(encoding, sent, padding), ALL), RGB)


@pytest.mark.parametrize("big", [False, True])
@pytest.mark.parametrize("encoding", ["rgb16", "bgr16", "rgba16", "bgra16", "16UC3"])
def test_of_channels_of_two_bytes_the_upper_one_is_shown(encoding: str, big: bool):
    numbers = np.zeros((1, 1, 4 if "a" in encoding else 3), dtype=">u2" if big else "<u2")
    numbers[0, 0, :3] = [0x1234, 0x5678, 0x9ABC]
    found = read_image(image(encoding, numbers, is_bigendian=big), ALL)
    expected = [0x12, 0x56, 0x9A]
    assert_array_equal(found, [[expected if encoding.startswith("r") else expected[::-1]]])


@pytest.mark.parametrize("big", [False, True])
@pytest.mark.parametrize(
    ("encoding", "kind"),
    [("mono8", "u1"), ("mono16", "u2"), ("16UC1", "u2"), ("32FC1", "f4"), ("64FC", "f8"),
     ("8UC1", "u1"), ("16SC1", "i2"), ("32SC1", "i4")],
)  # fmt: skip
def test_numbers_come_out_as_they_are(encoding: str, kind: str, big: bool):
    order = ">" if big else "<"
    numbers = np.array([[1, 2, 3], [100, 50, 0]], dtype=order + kind)
    found = read_image(image(encoding, numbers, padding=5, is_bigendian=big), ALL)
    assert_array_equal(found, [[1, 2, 3], [100, 50, 0]])
    assert found.dtype.isnative


def yuv_of(red: float, green: float, blue: float) -> tuple[int, int, int]:
    """A colour as brightness and two differences, by the weights of BT.601."""
    y = 0.299 * red + 0.587 * green + 0.114 * blue
    return round(y), round((blue - y) * 0.564 + 128), round((red - y) * 0.713 + 128)


COLOURS = [(200, 30, 60), (10, 180, 90), (128, 128, 128)]


@pytest.mark.parametrize("encoding", ["uyvy", "yuv422", "yuyv", "yuv422_yuy2"])
@pytest.mark.parametrize("colour", COLOURS)
def test_packed_brightness_and_differences_become_colours(
    encoding: str, colour: tuple[int, int, int]
):
    y, u, v = yuv_of(*colour)
    pair = [y, u, y, v] if encoding.startswith(("yuyv", "yuv422_")) else [u, y, v, y]
    sent = np.array([pair * 2] * 2, dtype=np.uint8).reshape(2, 4, 2)
    found = read_image(image(encoding, sent), ALL)
    assert_allclose(found.astype(int), np.full((2, 4, 3), colour), atol=4)


@pytest.mark.parametrize("encoding", ["nv12", "nv21"])
@pytest.mark.parametrize("colour", COLOURS)
def test_planes_of_brightness_and_differences_become_colours(
    encoding: str, colour: tuple[int, int, int]
):
    y, u, v = yuv_of(*colour)
    pair = [u, v] if encoding == "nv12" else [v, u]
    planes = np.array([[y] * 4] * 2 + [pair * 2], dtype=np.uint8)
    found = read_image(image(encoding, planes, height=2), ALL)
    assert_allclose(found.astype(int), np.full((2, 4, 3), colour), atol=4)


@pytest.mark.parametrize("pattern", ["rggb", "grbg", "gbrg", "bggr"])
def test_a_square_of_a_bayer_pattern_becomes_one_pixel(pattern: str):
    values = {"r": [10], "g": [40, 60], "b": [90]}
    square = np.array([values[letter].pop() for letter in pattern], dtype=np.uint8).reshape(2, 2)
    found = read_image(image(f"bayer_{pattern}8", np.tile(square, (2, 3))), ALL)
    assert_array_equal(found, np.full((2, 3, 3), [10, 50, 90]))
    wide = np.tile(square.astype("<u2") << 8, (2, 3))
    assert_array_equal(read_image(image(f"bayer_{pattern}16", wide), ALL), found)


@pytest.mark.parametrize(
    "encoding", ["rgb8", "mono8", "32FC1", "uyvy", "yuyv", "nv12", "bayer_rggb8"]
)
def test_too_many_pixels_are_thinned(encoding: str):
    data = np.zeros(400 * 600 * 4, dtype=np.uint8)
    bytes_each = {"rgb8": 3, "32FC1": 4, "uyvy": 2, "yuyv": 2}.get(encoding, 1)
    message = image(encoding, data[:1, None], width=600, height=400, step=600 * bytes_each)
    message.data = data
    found = read_image(message, 10_000)
    assert 1_000 < found.shape[0] * found.shape[1] <= 10_000
    assert found.shape[1] / found.shape[0] == pytest.approx(1.5, rel=0.05)


@pytest.mark.parametrize(
    "encoding", ["rgb8", "mono16", "uyvy", "yuyv", "nv12", "nv21", "bayer_bggr16"]
)
@pytest.mark.parametrize(("width", "height"), [(1, 1), (3, 1), (1, 3), (5, 7)])
def test_odd_sizes_are_read_too(encoding: str, width: int, height: int):
    data = np.zeros(width * height * 8 + 64, dtype=np.uint8)
    message = image(encoding, data[:1, None], width=width, height=height, step=0)
    message.data = data
    found = read_image(message, ALL)
    assert abs(found.shape[0] - height) <= height // 2 + 1
    assert abs(found.shape[1] - width) <= width // 2 + 1


@pytest.mark.parametrize(
    ("encoding", "fields", "sentence"),
    [
        ("rgb8", {"width": 3}, "3 x 1 pixels of 3 bytes need 9 bytes in rows of 6, and it has 6"),
        ("rgb8", {"height": 2}, "2 x 2 .* need 12 bytes in rows of 6, and it has 6"),
        ("rgb8", {"step": 5}, "need 6 bytes in rows of 5"),
        ("rgb8", {"height": 2**32 - 1}, "it is 2 x 4,294,967,295 pixels large"),
        ("nv12", {"height": 60_000, "step": 2**32 - 1}, "fewer than 90000 rows of 4294967295"),
        ("h264", {}, 'its encoding "h264" is not known: known are bayer_bggr16, .*8UC1'),
        ("8UC7", {}, "is not known"),
        ("", {}, 'its encoding "" is not known'),
    ],
)
def test_images_that_cannot_be_read_are_refused(
    encoding: str, fields: dict[str, Any], sentence: str
):
    message = image(encoding, np.zeros((1, 2, 3), dtype=np.uint8), **fields)
    with pytest.raises(DisplayMessageError, match=f"The Image cannot be drawn: .*{sentence}"):
        read_image(message, ALL)


def test_an_image_without_pixels_has_none():
    message = image("rgb8", np.zeros((1, 1, 3), dtype=np.uint8), width=0, height=0, data=b"")
    assert read_image(message, ALL).size == 0


@pytest.mark.parametrize(("count", "limit", "step"), [(100, 100, 1), (101, 100, 2), (400, 1, 20)])
def test_a_step_keeps_the_limit(count: int, limit: int, step: int):
    assert step_for(count, limit) == step
