import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from numpy.typing import NDArray

from studio.displays.display import Limits, Received
from studio.displays.drawing import Frustum
from studio.displays.image import ImageDisplay
from studio.errors import DisplayMessageError
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, received

INFO_TYPE = "sensor_msgs/msg/CameraInfo"
RGB = np.array([[[1, 2, 3], [4, 5, 6]]], dtype=np.uint8)
NAN, INF = math.nan, math.inf


def image(
    pixels: NDArray[Any],
    encoding: str = "rgb8",
    *,
    little: bool = True,
    **fields: Any,  # noqa: ANN401
) -> Received:
    size = {"height": len(pixels), "width": pixels.shape[1], "step": pixels[:1].nbytes}
    whole = {"encoding": encoding, "data": pixels.tobytes(), **size, **fields}
    return received("sensor_msgs/msg/Image", whole, little=little)


def info(
    fx: float = 100.0,
    fy: float = 100.0,
    *,
    p: list[float] | None = None,
    little: bool = True,
    **fields: Any,  # noqa: ANN401
) -> Received:
    """A camera of 200 x 100 pixels that looks along the middle."""
    projection = p or [fx, 0.0, 100.0, 0.0, 0.0, fy, 50.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    return received(
        INFO_TYPE, {"width": 200, "height": 100, "p": projection, **fields}, little=little
    )


def shown(display: ImageDisplay) -> Frustum:
    (placed,) = display.draw(NOW_NS).values()
    (shape,) = placed.shapes.values()
    assert isinstance(shape, Frustum)
    assert shape.image is not None
    assert shape.image.dtype == np.uint8
    return shape


def shades(pixels: NDArray[Any], encoding: str, **values: Any) -> list[list[int]]:  # noqa: ANN401
    display = ImageDisplay(TYPES, {key.replace("_", " "): one for key, one in values.items()})
    display.take(image(pixels, encoding))
    found = shown(display).image
    assert found is not None
    assert_array_equal(found[..., 0], found[..., 2])
    return found[..., 1].tolist()


@pytest.mark.parametrize("little", [True, False])
def test_a_picture_lies_where_its_camera_info_says(little: bool):
    display = ImageDisplay(TYPES)
    display.take(info(100.0, 50.0, little=little), "camera_info")
    assert display.draw(NOW_NS) == {}
    display.take(image(RGB, little=little))
    placed = display.draw(NOW_NS)["camera"]
    assert (placed.frame, placed.stamp_ns, placed.follows) == ("map", STAMP_NS, False)
    shape = shown(display)
    assert shape.fov_y_rad == pytest.approx(math.pi / 2)
    assert shape.aspect == pytest.approx(1.0)
    assert (shape.far_m, shape.rgb, shape.opacity) == (1.0, (0x7D, 0x7D, 0x7D), 1.0)
    assert_array_equal(shape.image, RGB)
    assert display.statuses() == ()


def test_without_a_projection_the_matrix_of_the_raw_picture_counts():
    display = ImageDisplay(TYPES)
    k = [50.0, 0.0, 100.0, 0.0, 50.0, 50.0, 0.0, 0.0, 1.0]
    display.take(info(p=[0.0] * 12, k=k), "camera_info")
    display.take(image(RGB))
    assert shown(display).fov_y_rad == pytest.approx(math.pi / 2)
    assert shown(display).aspect == pytest.approx(2.0)


@pytest.mark.parametrize(
    "wrong",
    [info(0.0, 0.0), info(NAN, 1.0), info(1.0, INF), info(-1.0, -1.0), info(1e-300, 1e-300),
     info(1e300, 1e300), info(1.0, 1e9), info(width=0), info(height=0)],
)  # fmt: skip
def test_a_camera_info_without_a_focal_length_is_told_and_the_angle_is_guessed(wrong: Received):
    display = ImageDisplay(TYPES)
    display.take(wrong, "camera_info")
    display.take(image(RGB))
    (status,) = display.statuses()
    assert (status.level, status.reason) == ("warn", "no_camera_info")
    assert status.sentence == (
        "The camera info has no focal length: the angle of view is guessed as 45 degrees."
    )
    assert shown(display).fov_y_rad == pytest.approx(math.pi / 4)
    assert shown(display).aspect == 2.0


def test_a_camera_info_that_has_not_come_is_told_until_it_comes():
    display = ImageDisplay(TYPES)
    display.take(image(RGB))
    (status,) = display.statuses()
    assert status.sentence.startswith("The camera info has not come: ")
    before = display.draw(NOW_NS)
    display.take(info(), "camera_info")
    assert display.statuses() == ()
    after = display.draw(NOW_NS)
    assert after is not before
    display.take(info(), "camera_info")
    assert display.draw(NOW_NS) is after


def test_a_camera_that_looks_beside_the_middle_is_told():
    display = ImageDisplay(TYPES)
    display.take(info(p=[100.0, 0, 30.0, 0, 0, 100.0, 50.0, 0, 0, 0, 1, 0]), "camera_info")
    display.take(image(RGB))
    assert [one.level for one in display.statuses()] == ["ok"]


def test_depths_reach_from_black_to_white():
    depths = np.array([[NAN, 1.0, 2.0], [INF, 3.0, -INF]], dtype=np.float32)
    assert shades(depths, "32FC1") == [[0, 0, 127], [255, 255, 0]]
    millimetres = np.array([[1000, 3000]], dtype=np.uint16)
    assert shades(millimetres, "16UC1") == [[0, 255]]
    assert shades(millimetres, "mono16", Normalize_Range=False, Max_Value=6000) == [[42, 127]]
    assert shades(np.array([[7, 200]], dtype=np.uint8), "mono8") == [[7, 200]]


def test_the_range_of_depths_is_evened_out_over_the_last_pictures():
    display = ImageDisplay(TYPES, {"Median window": 3})
    for far in (100.0, 100.0, 1000.0):
        display.take(image(np.array([[0.0, 50.0, far]], dtype=np.float32), "32FC1"))
        assert shown(display).image is not None
    found = shown(display).image
    assert found is not None
    assert found[0, :, 0].tolist() == [0, 127, 255]
    display.set("Median window", 1)
    found = shown(display).image
    assert found is not None
    assert found[0, :, 0].tolist() == [0, 12, 255]


def test_depths_that_are_none_are_told():
    display = ImageDisplay(TYPES)
    display.take(info(), "camera_info")
    display.take(image(np.full((2, 2), NAN, dtype=np.float32), "32FC1"))
    (status,) = display.statuses()
    assert (status.level, status.reason) == ("warn", "not_finite")
    assert not np.any(shown(display).image)


def test_properties_change_how_it_is_drawn():
    display = ImageDisplay(TYPES)
    display.take(info(), "camera_info")
    display.take(image(np.array([[1, 2]], dtype=np.uint8), "mono8"))
    before = shown(display).image
    display.set("Far clip", 3.0)
    display.set("Edge color", "#0a141e")
    display.set("Alpha", 0.0)
    assert (shown(display).far_m, shown(display).rgb) == (3.0, (10, 20, 30))
    assert shown(display).image is before
    (status,) = display.statuses()
    assert (status.reason, status.mend) == ("transparent", ("Alpha", 1.0))


def test_large_pictures_are_thinned_to_what_is_seen_in_3d():
    display = ImageDisplay(TYPES)
    display.limit(Limits(pixels=100))
    display.take(image(np.zeros((60, 80, 3), dtype=np.uint8)))
    found = shown(display)
    assert found.image is not None
    assert found.image.shape == (9, 12, 3)


def test_a_picture_without_pixels_and_one_of_an_unknown_encoding():
    display = ImageDisplay(TYPES)
    display.take(image(RGB))
    before = display.draw(NOW_NS)
    with pytest.raises(DisplayMessageError, match="is not known"):
        display.take(image(RGB, "h265"))
    assert display.draw(NOW_NS) is before
    display.take(image(RGB, width=0, height=0))
    assert display.draw(NOW_NS) == {}
    assert [one.reason for one in display.statuses()] == ["empty"]


def test_nothing_is_seen_after_a_reset():
    display = ImageDisplay(TYPES)
    display.take(info(), "camera_info")
    display.take(image(RGB))
    display.reset()
    assert display.draw(NOW_NS) == {}
    assert display.statuses() == ()
    display.take(image(RGB))
    assert [one.reason for one in display.statuses()] == ["no_camera_info"]
