"""Camera: what the page is told of a picture and its lens, beside OpenCV's projection."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from studio.displays.camera import BOTH, CameraDisplay
from studio.displays.display import Received
from studio.displays.drawing import CameraView
from studio.displays.properties import Value
from tests.support.display_messages import NOW_NS, STAMP_NS, TYPES, received
from tests.support.drawn import said

IMAGE, INFO = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
P = [400.0, 0, 300, -40, 0, 410, 230, 82, 0, 0, 1, 0]
BARREL = [-0.3, 0.1, 0.0, 0.0, 0.0]


def image(width: int = 640, height: int = 480) -> Received:
    size = {"width": width, "height": height, "step": 3 * width, "encoding": "rgb8"}
    return received(IMAGE, {**size, "data": bytes(3 * width * height)})


def info(**fields: object) -> Received:
    return received(INFO, {"width": 640, "height": 480, "p": P, **fields})


def display_with(values: dict[str, Value] | None = None, **fields: object) -> CameraDisplay:
    display = CameraDisplay(TYPES, values)
    display.take(image())
    display.take(info(**fields), "camera_info")
    return display


def view_of(display: CameraDisplay) -> CameraView:
    (placed,) = display.draw(NOW_NS).values()
    assert (placed.frame, placed.stamp_ns, placed.follows) == ("map", STAMP_NS, False)
    view = placed.shapes["view"]
    assert isinstance(view, CameraView)
    return view


def test_the_lens_projects_as_opencv_does():
    """A pixel's share of the width and the height, by the numbers that the page is sent."""
    lens = view_of(display_with()).lens
    assert lens is not None
    fx, fy, cx, cy, x_m, y_m = lens
    for place in np.random.default_rng(1).uniform((-1, -1, 1), (1, 1, 5), (20, 3)):
        u, v, w = np.array(P).reshape(3, 4) @ np.append(place, 1.0)
        ours = (
            fx * (place[0] - x_m) / place[2] + cx,
            fy * (place[1] - y_m) / place[2] + cy,
        )
        assert_allclose(ours, (u / w / 640, v / w / 480))


@pytest.mark.parametrize("size", [(320, 240), (1280, 960)])
def test_a_picture_of_another_size_has_the_same_lens(size: tuple[int, int]):
    display = display_with()
    before = view_of(display).lens
    display.take(image(*size))
    assert_allclose(view_of(display).lens or (), before or (1,))


def test_a_region_of_interest_is_cut_out():
    roi = {"x_offset": 160, "y_offset": 120, "width": 320, "height": 240}
    lens = view_of(display_with(roi=roi)).lens
    assert lens is not None
    assert_allclose(lens[:4], (400 / 320, 410 / 240, (300 - 160) / 320, (230 - 120) / 240))


def test_without_a_calibration_the_picture_is_there_and_that_is_said():
    display = CameraDisplay(TYPES)
    display.take(image())
    assert view_of(display).lens is None
    assert said(display) == [("error", "no_camera_info")]
    display.take(info(p=[0.0] * 12), "camera_info")
    assert view_of(display).lens is None
    assert "no focal length" in display.statuses()[0].sentence
    display.take(info(), "camera_info")
    assert view_of(display).lens is not None
    assert not display.statuses()


def test_a_distortion_that_is_not_undone_is_said_with_its_pixels():
    k = [400.0, 0, 320, 0, 400, 240, 0, 0, 1]
    display = display_with(d=BARREL, k=k, distortion_model="plumb_bob")
    view_of(display)
    (status,) = display.statuses()
    assert (status.level, status.reason) == ("warn", "distorted")
    assert "(plumb_bob): what is drawn is up to 80 pixels beside" in status.sentence
    display.topic = "/camera/image_rect"
    assert not display.statuses()


def test_a_model_that_is_not_computed_is_named():
    k = [400.0, 0, 320, 0, 400, 240, 0, 0, 1]
    display = display_with(d=BARREL, k=k, distortion_model="equidistant")
    view_of(display)
    assert "(equidistant), and this is not undone" in display.statuses()[0].sentence


def test_displays_that_are_switched_off_in_it_are_told_by_their_ids():
    display = display_with()
    display.beside({"d1": "Scan", "d2": "Map", "d3": "Camera"}, "d3")
    switches = [one.name for one in display.properties() if one.name.startswith("Visibility/")]
    assert switches == [
        "Visibility/Robot of this document", "Visibility/Grid of this document",
        "Visibility/Scan", "Visibility/Map",
    ]  # fmt: skip
    assert view_of(display).hidden == ()
    display.set("Visibility/Map", value=False)
    display.set("Visibility/Grid of this document", value=False)
    assert view_of(display).hidden == ("grid", "d2")
    display.set("Visibility", value=False)
    assert view_of(display).hidden == ("robot", "grid", "d1", "d2")
    display.set("Visibility/Scan", value=True)
    assert view_of(display).hidden == ("robot", "grid", "d2")
    display.set("Visibility", value=True)
    assert view_of(display).hidden == ()


def test_its_settings_are_rvizs():
    view = view_of(display_with())
    assert (view.rendering, view.overlay_alpha, view.zoom, view.far_m) == (BOTH, 0.5, 1.0, 100.0)
    values: dict[str, Value] = {"Image Rendering": "overlay", "Overlay Alpha": 0.0}
    display = display_with(values)
    assert view_of(display).rendering == "overlay"
    assert said(display) == [("warn", "transparent")]


def test_the_same_calibration_again_is_no_news():
    display = display_with()
    before = display.draw(NOW_NS)
    display.take(info(), "camera_info")
    assert display.draw(NOW_NS) is before
