"""Takes a picture of every panel: `python -m tests.support.panel_pictures FOLDER [name ...]`.

Each panel in front in its own place, in both themes, in a large window and on a tablet, and the
three that a phone shows; FOLDER gets `<panel>-<theme>-<width>x<height>.png`. Names of panels or
windows (`source`, `palette`) take only those.
"""

from __future__ import annotations

import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from tests.support.browser import open_browser
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable

    from playwright.sync_api import Browser, Page

    from tests.support.server import RunningStudio

Theme = Literal["dark", "light"]
THEMES: tuple[Theme, ...] = ("dark", "light")
WINDOWS = ((1600, 950), (1180, 820))
PHONE = (390, 844)
ON_PHONE = ("scene", "properties", "joints")
DIALOGS = {"palette": "Control+k", "keys": "?", "open": "Control+o"}
"""What a key opens over the page."""
_STILL_MS = 1200
PANEL_IDS = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return Object.keys((await import(new URL("panels.js", script))).PANELS);
}"""
SHOW_PANEL = """async (id) => {
  const script = document.querySelector('script[type="module"]').src;
  const { commandById } = await import(new URL("../lib/commands.js", script));
  while (commandById(`panel.${id}`) === undefined) await new Promise(requestAnimationFrame);
  commandById(`panel.${id}`).run();
}"""


@contextmanager
def tab_of(
    browser: Browser, studio: RunningStudio, theme: Theme, size: tuple[int, int]
) -> Generator[StudioPage]:
    """A tab of that size, with the robot drawn and something selected."""
    is_phone = size == PHONE
    more: dict[str, Any] = {"has_touch": True, "is_mobile": True} if is_phone else {}
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]},
        color_scheme=theme,
        reduced_motion="reduce",
        **more,
    )
    # Known to this browser: the pictures shall show the panels, not the note over one of them.
    context.add_init_script("localStorage.setItem('studio.graphics.said', 'true')")
    tab = StudioPage(context.new_page())
    tab.page.goto(studio.url)
    wait_until("the robot", tab.has_drawn_robot)
    yield tab
    assert tab.errors == []
    context.close()


def take(page: Page, folder: Path, name: str, theme: Theme, size: tuple[int, int]) -> None:
    """Write a picture once the page stands still."""
    page.mouse.move(2, 2)
    page.wait_for_timeout(_STILL_MS)
    page.screenshot(path=folder / f"{name}-{theme}-{size[0]}x{size[1]}.png")


def take_panels(tab: StudioPage, folder: Path, theme: Theme, size: tuple[int, int]) -> None:
    """Each panel in front, one after the other."""
    for panel in ON_PHONE if size == PHONE else tab.page.evaluate(PANEL_IDS):
        if wanted(panel):
            tab.page.evaluate(SHOW_PANEL, panel)
            take(tab.page, folder, panel, theme, size)


def take_dialogs(tab: StudioPage, folder: Path, theme: Theme, size: tuple[int, int]) -> None:
    """Each window that a key opens."""
    for name, key in DIALOGS.items():
        if wanted(name):
            tab.page.get_by_role("link", name="Studio: start page").focus()
            tab.page.keyboard.press(key)
            tab.page.locator("dialog").wait_for()
            if name == "palette":
                tab.page.locator(".palette-input").fill("wh")
            take(tab.page, folder, name, theme, size)
            tab.page.keyboard.press("Escape")


def wanted(name: str) -> bool:
    """Whether the command line asks for it."""
    return not sys.argv[2:] or name in sys.argv[2:]


def take_all(browser: Browser, folder: Path) -> None:
    """One studio, a fresh tab for each theme and size."""
    with (
        tempfile.TemporaryDirectory() as data,
        running_studio(["demo"], Path(data)) as studio,
    ):
        for theme, size in sizes():
            with tab_of(browser, studio, theme, size) as tab:
                if size != PHONE:
                    tab.page.get_by_role("treeitem", name="upper_arm", exact=True).click()
                take_panels(tab, folder, theme, size)
                if size == WINDOWS[0]:
                    take_dialogs(tab, folder, theme, size)


def sizes() -> Iterable[tuple[Theme, tuple[int, int]]]:
    """Every theme with every size."""
    return [(theme, size) for theme in THEMES for size in (*WINDOWS, PHONE)]


def pictures_into_folder(usage: str | None, take: Callable[[Browser, Path], None]) -> int:
    """Take all pictures anew, into the folder of the command line; answers the exit code."""
    if len(sys.argv) < 2:
        sys.stderr.write(f"{usage}\n")
        return 2
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for browser in open_browser():
        take(browser, folder)
    return 0


if __name__ == "__main__":
    sys.exit(pictures_into_folder(__doc__, take_all))
