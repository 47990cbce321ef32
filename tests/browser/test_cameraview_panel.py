"""The Camera panel: a thing in the scene lies where the lens of a real message puts it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.support.display_messages import point
from tests.support.display_pictures import DisplayCommands
from tests.support.display_samples import BASE, Sample
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.told_samples import told
from tests.support.wire import running_router

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser

    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(200)]
IMAGE, INFO = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
WIDTH, HEIGHT = 160, 120
FX, FY, CX, CY = 140.0, 150.0, 70.0, 64.0
PLACE = (1.3, -0.2, 0.6)
"""Of a ball, in the frame of the robot: the camera is at (0.3, 0, 0.5) and looks along x."""
PIXEL = """([x, y]) => {
  const canvas = document.querySelector(".cameraview-place canvas");
  const at = [Math.round(x * canvas.width), Math.round(y * canvas.height)];
  return [...canvas.getContext("2d").getImageData(...at, 1, 1).data];
}"""
SIZE = """() => {
  const { width, height } = document.querySelector(".cameraview-place canvas");
  return [width, height];
}"""


def white() -> dict[str, Any]:
    data = bytes([255]) * (3 * WIDTH * HEIGHT)
    size = {"height": HEIGHT, "width": WIDTH, "step": 3 * WIDTH}
    return {**size, "encoding": "rgb8", "data": data}


def info() -> dict[str, Any]:
    p = [FX, 0.0, CX, 0.0, 0.0, FY, CY, 0.0, 0.0, 0.0, 1.0, 0.0]
    return {"header": {"frame_id": "camera"}, "height": HEIGHT, "width": WIDTH, "p": p}


SEES = Sample(
    "sees", "Camera", IMAGE, white(), {"Image Rendering": "background"}, "camera",
    {"/sees/camera_info": (INFO, info())},
)  # fmt: skip
BLIND = Sample("blind", "Camera", IMAGE, white(), frame="camera")
BALL = Sample(
    "ball", "PointStamped", "geometry_msgs/msg/PointStamped", {"point": point(*PLACE)},
    {"Radius": 0.05, "Color": "#ff0000"},
)  # fmt: skip


def pixel_by_hand() -> tuple[float, float]:
    """Where a pinhole sees the ball, px of the picture."""
    x, y, z = -PLACE[1], 0.5 - PLACE[2], PLACE[0] - 0.3
    return FX * x / z + CX, FY * y / z + CY


def share_of(tab: StudioPage, u: float, v: float) -> tuple[float, float]:
    """Where a pixel of the picture is on the canvas, whose pixels are square for the lens."""
    width, height = tab.page.evaluate(SIZE)
    aspect, room = (WIDTH / FX) / (HEIGHT / FY), width / height
    across, down = (1.0, room / aspect) if aspect > room else (aspect / room, 1.0)
    return 0.5 + (u / WIDTH - 0.5) * across, 0.5 + (v / HEIGHT - 0.5) * down


def is_red(colour: list[int]) -> bool:
    return colour[0] > 100 and max(colour[1:3]) < colour[0] / 2


@pytest.mark.sweep
def test_the_scene_lies_on_the_pixels_of_the_picture(browser: Browser, tmp_path: Path):
    samples = [SEES, BLIND, BALL]
    with (
        running_router() as endpoint,
        told(endpoint, samples),
        running_studio(
            ["demo", "--connect", endpoint, "--router", "off"], tmp_path / "data"
        ) as studio,
        studio.client() as client,
        studio_page(browser, studio) as tab,
    ):
        commands = DisplayCommands(client, tab)
        commands.ask(type="connect_wire")
        commands.ask(type="set_fixed_frame", frame=BASE)
        for sample in samples:
            commands.add(sample)
        tab.page.evaluate(SHOW_PANEL, "cameraview")
        panel = tab.page.get_by_role("region", name="Camera")
        panel.get_by_role("img", name="The scene as sees sees it").wait_for()

        def ball_is_there() -> bool:
            return is_red(tab.page.evaluate(PIXEL, share_of(tab, *pixel_by_hand())))

        wait_until("the ball where the lens has it", ball_is_there, patience_s=60)
        u, v = pixel_by_hand()
        for beside in ((u - 12, v), (u + 12, v), (u, v - 12), (u, v + 12)):
            assert tab.page.evaluate(PIXEL, share_of(tab, *beside))[:3] == [255, 255, 255]
        assert panel.locator(".cameraview-said").count() == 0
        commands.ask(type="set_display_property", display="d1", name="Visibility/ball", value=False)
        wait_until("the ball to be hidden", lambda: not ball_is_there())
        panel.get_by_role("button", name="Camera display").click()
        tab.page.get_by_role("menuitemradio", name="blind").click()
        panel.get_by_text("The camera info has not come").wait_for()
        commands.ask(type="switch_displays", display="d2", enabled=False)
        panel.get_by_text("blind is switched off.").wait_for()
        assert tab.errors == []
