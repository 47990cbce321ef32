"""Records the half minute at the top of the README: `python -m tests.support.readme_recording`.

Chromium tells of each frame that the real page draws; those become an animated WebP, at the pace at
which they were drawn. What is only waited for is left out.
"""

# pyright: reportUnknownMemberType=false
from __future__ import annotations

import base64
import io
import tempfile
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from PIL import Image
from playwright.sync_api import Error

from tests.support.browser import open_browser
from tests.support.demos import running_demo
from tests.support.readme_pictures import FOLDER, show
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, wait_until
from tests.support.wire import running_router
from tests.support.wired_tab import add_displays

if TYPE_CHECKING:
    from collections.abc import Generator

    from playwright.sync_api import Browser, Page, ViewportSize

FILE = FOLDER / "half-a-minute.webp"
VIEWPORT: Final[ViewportSize] = {"width": 1280, "height": 760}
SIZE_PX = (960, 570)
_FRAME_S = 0.1
"""Frames that come sooner than this after the last one are left out."""
_LONGEST_S = 0.4
"""A page that stands still for longer is shown so long."""
_QUALITY = 62


@dataclass
class Recording:
    """Frames of a page, each with the time when it was drawn, seconds."""

    page: Page
    frames: list[tuple[float, bytes]] = field(default_factory=list[tuple[float, bytes]])

    @contextmanager
    def rolling(self) -> Generator[None]:
        """Record what the page draws within the block."""
        session = self.page.context.new_cdp_session(self.page)

        def keep(event: dict[str, Any]) -> None:
            self.frames.append((event["metadata"]["timestamp"], base64.b64decode(event["data"])))
            with suppress(Error):  # the last ones may come after the end
                session.send("Page.screencastFrameAck", {"sessionId": event["sessionId"]})

        session.on("Page.screencastFrame", keep)
        session.send("Page.startScreencast", {"format": "jpeg", "quality": 92, "everyNthFrame": 1})
        yield
        session.send("Page.stopScreencast")

    def save(self, file: Path) -> float:
        """Write the frames as an animated WebP; return its length in seconds."""
        shown = [self.frames[0]]
        for frame in self.frames[1:]:
            if frame[0] - shown[-1][0] >= _FRAME_S:
                shown.append(frame)
        times_s = [time_s for time_s, _ in shown]
        lasts_ms = [
            round(1000 * min(later - earlier, _LONGEST_S))
            for earlier, later in zip(
                times_s, [*times_s[1:], times_s[-1] + _LONGEST_S], strict=True
            )
        ]
        pictures = [
            Image.open(io.BytesIO(data)).convert("RGB").resize(SIZE_PX, Image.Resampling.LANCZOS)
            for _, data in shown
        ]
        pictures[0].save(
            file,
            save_all=True,
            append_images=pictures[1:],
            duration=lasts_ms,
            loop=0,
            quality=_QUALITY,
            method=6,
        )
        return sum(lasts_ms) / 1000


def turn_a_knob(tab: StudioPage) -> None:
    """Drag the radius of the wheels to and fro: the robot follows."""
    tab.seek("wheel_radius")
    slider = tab.slider("wheel_radius")
    box = slider.bounding_box()
    assert box is not None
    begin = float(slider.evaluate("one => (one.value - one.min) / (one.max - one.min)"))
    y = box["y"] + box["height"] / 2
    mouse = tab.page.mouse
    mouse.move(box["x"] + box["width"] * begin, y)
    mouse.down()
    for share in (0.9, 0.2):
        mouse.move(box["x"] + box["width"] * share, y, steps=12)
        tab.page.wait_for_timeout(300)
    mouse.up()
    tab.page.wait_for_timeout(500)


def ask_where_from(tab: StudioPage) -> None:
    """Where the numbers of the upper arm come from, and the line of one in its source."""
    tab.page.get_by_role("treeitem", name="upper_arm", exact=True).click()
    tab.page.wait_for_timeout(700)
    show(tab, "Where from")
    tab.page.wait_for_timeout(1200)
    tab.page.get_by_role("button", name="arm.xacro:").first.click()
    tab.page.wait_for_timeout(1800)


def prepare_the_live_system(tab: StudioPage) -> None:
    """Choose the layout for what is live, and the frame that stands still; the demo has joined."""
    tab.page.get_by_text("ROS: connected").first.wait_for()
    tab.page.keyboard.press("Control+2")
    frame = tab.page.get_by_role("textbox", name="Fixed frame")
    frame.fill("odom")
    frame.press("Enter")
    tab.page.get_by_role("button", name="Follow base_footprint").click()
    tab.page.wait_for_timeout(2000)


def see_a_scan(tab: StudioPage) -> None:
    """The rover's scan, map and plan come into the 3D view, and it drives."""
    add_displays(tab)
    tab.page.wait_for_timeout(1500)
    tab.page.wait_for_timeout(4000)


def send_a_goal(tab: StudioPage) -> None:
    """A turtle turns to an angle, with its feedback beside it."""
    show(tab, "Turtlesim")
    tab.page.wait_for_timeout(800)
    show(tab, "Actions")
    panel = tab.page.get_by_role("region", name="Actions", exact=True)
    panel.get_by_role("button", name="/turtle1/rotate_absolute").click()
    panel.get_by_label("theta").fill("3.0")
    tab.page.wait_for_timeout(500)
    panel.get_by_role("button", name="Send goal").click()
    tab.page.wait_for_timeout(5000)


def record(browser: Browser) -> float:
    """Record the four scenes; return the length in seconds."""
    with (
        running_router() as endpoint,
        tempfile.TemporaryDirectory() as folder,
        running_demo(endpoint, "turtlesim_node"),
        running_studio(
            ["demo", "--connect", endpoint, "--router", "off"], Path(folder), moving=True
        ) as studio,
    ):
        context = browser.new_context(viewport=VIEWPORT, color_scheme="dark")
        context.add_init_script("""localStorage.setItem("studio.graphics.said", "true")""")
        tab = StudioPage(context.new_page())
        tab.open(studio.url)
        recording = Recording(tab.page)
        wait_until("the sliders are there", lambda: tab.page.get_by_role("slider").count() > 0)
        with recording.rolling():
            tab.page.wait_for_timeout(800)
            turn_a_knob(tab)
            ask_where_from(tab)
        prepare_the_live_system(tab)
        with recording.rolling():
            see_a_scan(tab)
            send_a_goal(tab)
        context.close()
        assert tab.errors == []
        return recording.save(FILE)


def main() -> None:
    """Record, and say how long and how large it became."""
    for browser in open_browser():
        length_s = record(browser)
        print(f"{FILE.name}: {length_s:.0f} s, {FILE.stat().st_size / 1e6:.1f} MB")  # noqa: T201


if __name__ == "__main__":
    main()
