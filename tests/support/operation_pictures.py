"""Takes the help's pictures of what is done in ROS 2: `python -m tests.support.operation_pictures`.

Services, actions, parameters and publishing, each with a demo node that does what is asked.
"""

from __future__ import annotations

import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from tests.support.browser import open_browser
from tests.support.demos import running_demo
from tests.support.help_pictures import RUN, Camera
from tests.support.panel_pictures import SHOW_PANEL, THEMES, tab_of
from tests.support.server import running_studio
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Locator, Page

WINDOW = (720, 760)
_HIGHEST_PX = 430
_DEMOS = ("radio_dj", "service_server_node", "turtlesim_node")
_CONNECT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/ros.js", script))).connectRos();
}"""
_TWIST = '"{linear: {x: 2.0}, angular: {z: 1.8}}"'


def paste(panel: Locator, line: str) -> None:
    panel.get_by_role("searchbox").fill(line)


def seen(panel: Locator, text: str) -> Locator:
    """A text of what is chosen; that of the list beside it may be hidden."""
    return panel.locator(".operations-chosen").get_by_text(text).first


def press(panel: Locator, name: str) -> None:
    panel.get_by_role("button", name=name, exact=True).first.click()


def call(panel: Locator) -> None:
    kind = "example_interfaces/srv/AddTwoInts"
    paste(panel, f'ros2 service call /add_two_ints {kind} "{{a: 41, b: 1}}"')
    press(panel, "Call")
    seen(panel, "sum").wait_for()


def send(panel: Locator) -> None:
    kind = "radio_station_interfaces/action/ChooseSong"
    paste(panel, f'ros2 action send_goal /choose_song {kind} "{{song_name: Clocks}}"')
    press(panel, "Send goal")
    press(panel, "Cancel")
    seen(panel, "Cancelled after").wait_for()
    press(panel, "Send goal")
    seen(panel, "25 %").wait_for()


def choose(panel: Locator) -> None:
    press(panel, "/turtlesim")
    seen(panel, "background_r").wait_for()


def publish(panel: Locator) -> None:
    kind = "geometry_msgs/msg/Twist"
    paste(panel, f"ros2 topic pub --rate 10 /turtle1/cmd_vel {kind} {_TWIST}")
    start = panel.get_by_role("button", name="10 times a second")
    stop = panel.get_by_role("button", name="Stop publishing (10 Hz)")
    start.or_(stop).first.wait_for()
    if start.is_visible():  # of a picture before, it is publishing already
        start.click()
    seen(panel, "listening").wait_for()


PANELS: dict[str, tuple[str, Callable[[Locator], None]]] = {
    "services": ("Services", call),
    "actions": ("Actions", send),
    "parameters": ("Parameters", choose),
    "publish": ("Publish", publish),
}


def take_large(page: Page, camera: Camera, name: str, panel: Locator, highest_px: int) -> None:
    """A panel that has the whole window for as long as its picture is taken."""
    page.evaluate(RUN, "maximize")
    box = panel.bounding_box()
    assert box is not None
    camera.take(name, box, highest_px=highest_px)
    page.evaluate(RUN, "maximize")


def take(page: Page, camera: Camera) -> None:
    page.evaluate(_CONNECT)
    for name, (title, do) in PANELS.items():
        page.evaluate(SHOW_PANEL, name)
        panel = page.locator(f"section.operations[aria-label='{title}']")
        do(panel)
        take_large(page, camera, name, panel, _HIGHEST_PX)


def main() -> None:
    """Take them all anew."""
    for browser in open_browser():
        with (
            running_router() as router,
            tempfile.TemporaryDirectory() as data,
            ExitStack() as demos,
        ):
            for name in _DEMOS:
                demos.enter_context(running_demo(router, name))
            place = ["demo", "--connect", router, "--router", "off"]
            with running_studio(place, Path(data)) as studio:
                for theme in THEMES:
                    with tab_of(browser, studio, theme, WINDOW) as tab:
                        take(tab.page, Camera(tab, theme))


if __name__ == "__main__":
    main()
