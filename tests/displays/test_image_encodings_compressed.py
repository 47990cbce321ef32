import io
import struct
import zlib
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from studio.displays.image_encodings import read_compressed
from studio.errors import DisplayMessageError
from studio.ros.cdr import codec_of
from tests.support.display_messages import TYPES, received

COMPRESSED = "sensor_msgs/msg/CompressedImage"
ALL = 1_000_000
RED = np.full((24, 32, 3), [200, 20, 10], dtype=np.uint8)


def picture(pixels: Any, name: str) -> bytes:  # noqa: ANN401
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, name)
    return buffer.getvalue()


def message(data: bytes, said: str) -> Any:  # noqa: ANN401
    whole = received(COMPRESSED, {"format": said, "data": data})
    return codec_of(TYPES.message(COMPRESSED)).decode(whole.cdr)


@pytest.mark.parametrize(
    ("name", "said"),
    [("JPEG", "jpeg"), ("PNG", "png"), ("JPEG", "rgb8; jpeg compressed bgr8"), ("PNG", "")],
)
def test_pictures_are_unpacked_in_their_colours(name: str, said: str):
    found = read_compressed(message(picture(RED, name), said), ALL)
    assert_allclose(found.astype(int), RED, atol=6)


def test_grey_pictures_and_depths_are_numbers():
    grey = np.arange(12, dtype=np.uint8).reshape(3, 4)
    assert_array_equal(read_compressed(message(picture(grey, "PNG"), "mono8; png"), ALL), grey)
    depths = (np.arange(12) * 1000).astype(np.uint16).reshape(3, 4)
    found = read_compressed(message(picture(depths, "PNG"), "16UC1; png compressed"), ALL)
    assert_array_equal(found, depths)
    header = struct.pack("<iff", 0, 0.0, 0.0)
    said = "16UC1; compressedDepth png"
    assert_array_equal(read_compressed(message(header + picture(depths, "PNG"), said), ALL), depths)


def test_depths_of_floats_are_kept_as_their_inverse():
    depths_m = np.array([[0.5, 1.0], [4.0, np.nan]])
    near, far = 1000.0, 20.0
    steps = np.nan_to_num(near / depths_m + far).astype(np.uint16)
    data = struct.pack("<iff", 0, near, far) + picture(steps, "PNG")
    found = read_compressed(message(data, "32FC1; compressedDepth"), ALL)
    assert_allclose(found, depths_m, rtol=0.01)


@pytest.mark.parametrize("name", ["JPEG", "PNG"])
def test_too_many_pixels_are_thinned(name: str):
    large = np.tile(RED, (40, 40, 1))
    found = read_compressed(message(picture(large, name), name.lower()), 10_000)
    assert 2_000 < found.shape[0] * found.shape[1] <= 10_000
    assert_allclose(found[0, 0].astype(int), RED[0, 0], atol=6)


@pytest.mark.parametrize(
    ("data", "said", "sentence"),
    [
        (b"", "jpeg", "no JPEG or PNG"),
        (b"\x00\x00\x00\x01" * 20, "h264", r'no JPEG or PNG \(format "h264"\)'),
        (picture(RED, "PNG")[:60], "png", "no JPEG or PNG"),
        (picture(RED, "JPEG")[:-200], "jpeg", "no JPEG or PNG"),
        (bytes(100), "16UC1; compressedDepth rvl", 'depths are read from PNG, .* "16UC1; compr'),
        (b"", "16UC1; compressedDepth", "depths are read from PNG"),
    ],
)
def test_what_is_no_picture_is_refused(data: bytes, said: str, sentence: str):
    with pytest.raises(DisplayMessageError, match=sentence):
        read_compressed(message(data, said), ALL)


def test_a_picture_too_large_to_unpack_is_refused_by_what_its_head_says():
    whole = bytearray(picture(np.zeros((1, 1), dtype=np.uint8), "PNG"))
    whole[16:24] = struct.pack(">II", 10_000, 8_000)
    whole[29:33] = struct.pack(">I", zlib.crc32(whole[12:29]))
    with pytest.raises(DisplayMessageError, match="it is 10,000 x 8,000 pixels large"):
        read_compressed(message(bytes(whole), "png"), ALL)
