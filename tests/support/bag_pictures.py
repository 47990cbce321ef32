"""Takes pictures of a bag, of help and README: `python -m tests.support.bag_pictures`.

The demo's rover is recorded from the page, with lines of a log among it, and opened again.
"""

from __future__ import annotations

import re
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.support.browser import open_browser
from tests.support.demos import node_at
from tests.support.help_pictures import PANELS_WINDOW, RUN, Camera
from tests.support.panel_pictures import SHOW_PANEL, THEMES
from tests.support.panel_pictures import tab_of as small_tab
from tests.support.readme_pictures import tab_of, take
from tests.support.server import running_studio
from tests.support.studio_page import wait_until
from tests.support.timeline import TRACK_Y_PX, Timeline
from tests.support.wire import running_router
from tests.support.wired_tab import add_displays, connect, look_at_odometry

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio
    from tests.support.studio_page import StudioPage

PANEL_WINDOW: Final = (720, 640)
LINES: Final = (
    (3, "info", "driving to the dock"),
    (8, "warn", "left wheel slips"),
    (4, "warn", "left wheel slips"),
    (3, "error", "dock not seen"),
    (9, "info", "dock seen again"),
    (9, "info", "docked"),
)
"""Seconds after the one before it, level and text."""
MARKS: Final = ((0.46, "slipped"), (0.79, "docking"))
"""Bookmarks: where on the timeline, and what they are called."""
LOOPED: Final = (0.38, 0.56)


def panel_of(tab: StudioPage, panel: str, name: str) -> Locator:
    tab.page.evaluate(SHOW_PANEL, panel)
    return tab.page.get_by_role("region", name=name, exact=True)


def record(tab: StudioPage, endpoint: str) -> None:
    """Record all that is said, as long as the lines take."""
    panel = panel_of(tab, "bag", "Bag")
    panel.get_by_role("button", name="Record", exact=True).click()
    panel.get_by_role("textbox", name="Name").fill("docking")
    panel.get_by_role("button", name="Start recording").click()
    panel.get_by_role("region", name="Recording").get_by_text("/odom").wait_for()
    with node_at(endpoint, "docking") as node:
        for after_s, level, text in LINES:
            time.sleep(after_s)
            getattr(node.get_logger(), level)(text)
        time.sleep(LINES[0][0])
    panel.get_by_role("button", name="Stop").click()
    panel.get_by_role("region", name="Recorded").wait_for()


def open_recorded(tab: StudioPage) -> Timeline:
    panel = panel_of(tab, "bag", "Bag")
    panel.get_by_role("button", name="Bags", exact=True).click()
    panel.get_by_role("button", name=re.compile("^docking")).first.click()
    tab.page.wait_for_url("**/d/docking*")
    wait_until("the robot of the bag", tab.has_drawn_robot)
    timeline = Timeline(tab)
    timeline.slider.wait_for()
    return timeline


def go_to(timeline: Timeline, share: float, to: float | None = None) -> None:
    """Show that part of the bag; with `to`, loop what is between."""
    mouse, box = timeline.tab.page.mouse, timeline.box
    mouse.move(box["x"] + box["width"] * share, box["y"] + (TRACK_Y_PX if to is None else 6))
    mouse.down()
    if to is not None:
        mouse.move(box["x"] + box["width"] * to, box["y"] + 6, steps=6)
    mouse.up()


def mark(timeline: Timeline) -> None:
    """Name two moments, loop a part, and show one of them."""
    tab = timeline.tab
    for share, name in MARKS:
        go_to(timeline, share)
        timeline.slider.press("b")
        panel = panel_of(tab, "bag", "Bag")
        panel.get_by_role("button", name="Contents", exact=True).click()
        boxes = panel.get_by_role("textbox", name=re.compile("^Name of"))
        wait_until("the bookmark", lambda boxes=boxes, name=name: boxes.count() > 0)
        box = boxes.last if share == MARKS[-1][0] else boxes.first
        box.fill(name)
        box.press("Enter")
    go_to(timeline, *LOOPED)
    go_to(timeline, MARKS[0][0])


def take_readme(tab: StudioPage) -> None:
    """All of the page: where the rover was, the line of its speed, and what it said."""
    add_displays(tab)
    look_at_odometry(tab)
    tab.page.keyboard.press("Control+2")
    tab.page.evaluate(SHOW_PANEL, "log")
    tab.page.evaluate(SHOW_PANEL, "plot")
    tab.page.get_by_role("button", name="Fit", exact=False).first.click()
    take(tab, "bag-dark")


def take_help(browser: Browser, studio: RunningStudio, address: str) -> None:
    for theme in THEMES:
        with small_tab(browser, studio, theme, PANELS_WINDOW) as tab:
            tab.page.goto(address)
            timeline = Timeline(tab)
            timeline.slider.wait_for()
            tab.page.evaluate(SHOW_PANEL, "properties")
            Camera(tab, theme).take_part("timeline", tab.page.locator(".timeline"))
        with small_tab(browser, studio, theme, PANEL_WINDOW) as tab:
            tab.page.goto(address)
            panel = panel_of(tab, "bag", "Bag")
            tab.page.evaluate(RUN, "maximize")
            Camera(tab, theme).take_part("bag", panel)


def main() -> None:
    """Take them all anew."""
    with (
        running_router() as endpoint,
        tempfile.TemporaryDirectory() as folder,
        running_studio(
            ["demo", "--connect", endpoint, "--router", "off"], Path(folder), moving=True
        ) as studio,
    ):
        for browser in open_browser():
            with tab_of(browser, studio, "dark") as tab:
                connect(tab)
                record(tab, endpoint)
                timeline = open_recorded(tab)
                mark(timeline)
                address = tab.page.url
                take_help(browser, studio, address)
                take_readme(tab)


if __name__ == "__main__":
    main()
