"""A camera of 1920 x 1080 at 30 Hz in the Image panel: every picture right, in order, none late."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest
from PIL import Image

from tests.support.numbered_camera import (
    GREEN,
    TOPIC,
    WATCH,
    color_of,
    numbered_camera,
)
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import running_router
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.demos import RunningDemo
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]
SIZE, RATE_HZ = (1920, 1080), 30.0
PICTURES = 60
HIDE = """(isHidden) => {
  Object.defineProperty(document, "hidden", { get: () => isHidden, configurable: true });
  document.dispatchEvent(new Event("visibilitychange"));
}"""
STREAMS = "navigator.locks.query().then(({ held }) => held.map(({ name }) => name))"
ROUTERLESS = ["demo", "--router", "off", "--connect"]


def number_of(found: list[int]) -> int:
    """Which picture it is, all of whose pixels are its own."""
    number = found[0] + (found[1] << 8)
    assert found == [*color_of(number), *GREEN]
    return number


def watch(tab: StudioPage) -> list[int]:
    """The numbers of pictures, as they followed each other on the screen."""
    tab.page.evaluate(WATCH)
    wait_until("pictures", lambda: tab.page.evaluate("seen.length") > PICTURES, patience_s=120)
    seen: Any = tab.page.evaluate("seen")
    return [number_of(found) for found in seen]


def look_at_a_pixel(panel: Locator) -> None:
    """What is told of it is what the camera sent."""
    panel.get_by_role("button", name="Zoom in").click()
    panel.get_by_role("img", name=f"Picture of {TOPIC}").hover()
    told = panel.locator("output")
    wait_until("the pixel", lambda: ": " in told.inner_text())
    red, green, blue = (int(one) for one in told.inner_text().partition(": ")[2].split())
    assert (red, green, blue) == color_of(red + (green << 8))


def save(tab: StudioPage, panel: Locator, file: Path) -> None:
    """All of the picture, however it is looked at."""
    with tab.page.expect_download() as saved:
        panel.get_by_role("button", name="Save the picture as PNG").click()
    assert saved.value.suggested_filename == "eye_image_raw.png"
    saved.value.save_as(file)
    with Image.open(file) as image:
        assert image.size == SIZE
        corners: list[Any] = [image.getpixel((0, 0)), image.getpixel((1919, 1079))]
    number_of([one for corner in corners for one in corner[:3]])


def hear(camera: RunningDemo, listeners: int) -> None:
    wait_until("listeners", lambda: camera.lines[-1:] == [f"listeners {listeners}\n"])


def sleep_a_while(tab: StudioPage, camera: RunningDemo) -> None:
    """A tab that nobody can see leaves its stream to others, and hears nothing."""

    def hears(streams: list[str]) -> None:
        wait_until(f"{streams}", lambda: tab.page.evaluate(STREAMS) == streams)
        hear(camera, len(streams))

    hears(["studio-bulk-1"])
    tab.page.evaluate(HIDE, arg=True)
    hears([])
    tab.page.evaluate(HIDE, arg=False)
    hears(["studio-bulk-1"])


@pytest.mark.sweep
def test_a_camera_of_1080p_at_30_hz_is_seen_picture_after_picture(browser: Browser, tmp_path: Path):
    with (
        running_router() as endpoint,
        running_studio([*ROUTERLESS, endpoint], tmp_path / "data") as studio,
        numbered_camera(endpoint, SIZE, RATE_HZ) as camera,
        studio_page(browser, studio, view=False) as tab,
    ):
        connect(tab)
        tab.page.evaluate(SHOW_PANEL, "image")
        panel = tab.page.get_by_role("region", name="Image")
        panel.get_by_text(" · rgb8 · ").wait_for()
        numbers = watch(tab)
        assert all(before < after for before, after in pairwise(numbers))
        look_at_a_pixel(panel)
        save(tab, panel, tmp_path / "saved.png")
        sleep_a_while(tab, camera)
        tab.page.evaluate(SHOW_PANEL, "plot")
        hear(camera, 0)
        assert tab.errors == []
