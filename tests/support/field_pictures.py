"""Takes the help's pictures of turtlesim and Jerry: `python -m tests.support.field_pictures`."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from tests.support.browser import open_browser
from tests.support.demos import running_demo
from tests.support.help_pictures import Camera
from tests.support.operation_pictures import take_large
from tests.support.panel_pictures import SHOW_PANEL, THEMES, tab_of
from tests.support.server import running_studio
from tests.support.wire import running_router
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Locator, Page

WINDOW = (860, 640)
_HIGHEST_PX = 560
_TURN_MS = 2600
_STEP_MS = 1500


def draw_lines(panel: Locator) -> None:
    """Two turtles, and the way of one of them."""
    page, field = panel.page, panel.get_by_role("application")
    panel.get_by_text("0.0 m/s").first.wait_for()
    panel.get_by_role("button", name="turtle1").click()
    field.focus()
    for keys in (("ArrowUp",), ("ArrowUp", "ArrowLeft")):
        for key in keys:
            page.keyboard.down(key)
        page.wait_for_timeout(_TURN_MS)
        for key in keys:
            page.keyboard.up(key)
    if panel.get_by_role("button", name="turtle2").count() == 0:
        panel.get_by_role("button", name="New turtle").click()
        field.click(position={"x": 90, "y": 120})
    panel.get_by_role("button", name="turtle2").wait_for()


def walk(panel: Locator) -> None:
    """Some commands, and how far it is to somewhere else."""
    panel.get_by_text("Jerry is at").wait_for()
    panel.get_by_label("Steps").fill("3")
    for word in ("Forward", "Left", "Forward", "Left"):
        panel.get_by_role("button", name=word, exact=True).click()
        panel.page.wait_for_timeout(_STEP_MS)
    panel.get_by_label("x", exact=True).fill("0")
    panel.get_by_role("button", name="How far?").click()
    panel.get_by_text("exact").first.wait_for()


PANELS: dict[str, Callable[[Locator], None]] = {"turtlesim": draw_lines, "jerry": walk}


def take(page: Page, camera: Camera) -> None:
    for name, do in PANELS.items():
        page.evaluate(SHOW_PANEL, name)
        panel = page.locator(f"section.{name}")
        do(panel)
        take_large(page, camera, name, panel, _HIGHEST_PX)


def main() -> None:
    """Take them all anew."""
    for browser in open_browser():
        for theme in THEMES:
            with (
                running_router() as router,
                tempfile.TemporaryDirectory() as data,
                running_demo(router, "turtlesim_node"),
                running_demo(router, "jerry_robot"),
                running_studio(
                    ["demo", "--connect", router, "--router", "off"], Path(data)
                ) as studio,
                tab_of(browser, studio, theme, WINDOW) as tab,
            ):
                connect(tab)
                take(tab.page, Camera(tab, theme))


if __name__ == "__main__":
    main()
