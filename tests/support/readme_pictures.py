"""Takes the pictures of the README: `python -m tests.support.readme_pictures`."""

from __future__ import annotations

import io
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

from tests.support.browser import open_browser
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.run_studio import robot_workspace
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage
from tests.support.wire import running_router
from tests.support.wired_tab import add_displays, connect, look_at_odometry

if TYPE_CHECKING:
    from collections.abc import Generator
    from typing import Literal

    from playwright.sync_api import Browser

    from tests.support.server import RunningStudio

FOLDER = Path(__file__).resolve().parents[2] / "frontend_assets/screenshots"
_STILL_MS = 3000
"""After this time at rest the view has been drawn finely."""
_DRIVEN_MS = 15_000
"""So far the rover has driven, and so much of it is in the plot."""


@contextmanager
def tab_of(
    browser: Browser, studio: RunningStudio, theme: Literal["dark", "light"]
) -> Generator[StudioPage]:
    """A tab of the README's size."""
    context = browser.new_context(
        viewport={"width": 1600, "height": 950}, color_scheme=theme, reduced_motion="reduce"
    )
    # With shadows, as a reader with a graphics card sees it, however slowly they are drawn here.
    context.add_init_script("""localStorage.setItem("studio.graphics", '"full"')""")
    tab = StudioPage(context.new_page())
    tab.open(studio.url)
    yield tab
    assert tab.errors == []
    context.close()


def take(tab: StudioPage, name: str) -> None:
    """Write a picture of the whole page once it stands still."""
    tab.page.mouse.move(2, 2)
    tab.page.wait_for_timeout(_STILL_MS)
    with Image.open(io.BytesIO(tab.page.screenshot())) as picture:
        smaller(picture.convert("RGB")).save(FOLDER / f"{name}.png", optimize=True)


def smaller(picture: Image.Image) -> Image.Image:
    """The same without the last bit of each colour, which nobody sees: a fifth less in a file."""
    return picture.point([min(255, (value + 1) & ~1) for value in range(256)] * 3)


def show(tab: StudioPage, panel: str) -> None:
    tab.page.get_by_role("tab", name=panel).click()


def explain(tab: StudioPage) -> None:
    """Where the upper arm comes from, and the source of it."""
    tab.page.get_by_role("treeitem", name="upper_arm", exact=True).click()
    show(tab, "Where from")
    tab.page.get_by_role("button", name="arm.xacro:").first.click()


def save_variant(tab: StudioPage, name: str, note: str) -> None:
    show(tab, "Variants")
    panel = tab.page.get_by_role("region", name="Variants")
    panel.get_by_role("button", name="Save as variant").click()
    form = panel.get_by_role("form", name="New variant")
    form.get_by_label("Name").fill(name)
    form.get_by_label("Note").fill(note)
    form.get_by_role("button", name="Save").click()
    panel.get_by_role("button", name=name, pressed=True).wait_for()


def compare(tab: StudioPage) -> None:
    """Two variants, the other one as a ghost."""
    save_variant(tab, "Road", "small wheels")
    show(tab, "Properties")
    tab.drag_slider("wheel_radius", 0.8)
    show(tab, "Properties")
    tab.drag_slider("mast_height", 0.75)
    save_variant(tab, "Tall grass", "large wheels, a high mast")
    panel = tab.page.get_by_role("region", name="Variants")
    panel.get_by_role("button", name="More for Road").click()
    tab.page.get_by_role("menuitem", name="Compare with the current robot").click()
    panel.get_by_role("row", name="wheel_radius property").wait_for()
    panel.get_by_role("button", exact=True, name="Over").click()
    tab.page.get_by_role("searchbox", name="Filter properties").fill("")
    tab.page.get_by_role("button", name="Fit", exact=False).first.click()


def take_live(browser: Browser) -> None:
    """The moving graph of the demo, in the layout for what is live."""
    with (
        running_router() as endpoint,
        tempfile.TemporaryDirectory() as folder,
        running_studio(
            ["demo", "--connect", endpoint, "--router", "off"], Path(folder), moving=True
        ) as studio,
        tab_of(browser, studio, "dark") as tab,
    ):
        connect(tab)
        # Before there is much to draw, which leaves a slow machine no time for a click.
        frame = tab.page.get_by_role("textbox", name="Fixed frame")
        frame.fill("odom")
        frame.press("Enter")
        add_displays(tab)
        tab.page.keyboard.press("Control+2")
        look_at_odometry(tab)
        tab.page.wait_for_timeout(_DRIVEN_MS)
        tab.page.get_by_role("button", name="Fit", exact=False).first.click()
        take(tab, "live-dark")


def join(browser: Browser, studio: RunningStudio, name: str) -> StudioPage:
    """A student's page, without the 3D view, for there are several of them."""
    context = browser.new_context(viewport={"width": 1200, "height": 800})
    context.add_cookies([{"name": "without_view", "value": "1", "url": studio.origin}])
    tab = StudioPage(context.new_page())
    tab.page.goto(studio.origin)
    tab.page.get_by_label("Code").fill(studio.class_code)
    tab.page.get_by_label("Your name").fill(name)
    tab.page.get_by_role("button", name="Join").click()
    tab.page.get_by_text("You are looking").wait_for()
    return tab


def find_the_wheel(tab: StudioPage, steps: int) -> None:
    """Do the first steps of a lesson, on a copy of one's own."""
    tab.page.get_by_role("button", name="My copy", exact=True).click()
    tab.page.get_by_text("Your copy: only you").wait_for()
    tab.page.evaluate(SHOW_PANEL, "lessons")
    lessons = tab.page.get_by_role("region", name="Lessons", exact=True)
    lessons.get_by_role("searchbox").fill("find_the_wheel")
    lessons.get_by_role("button", name="find_the_wheel").click()
    tab.page.evaluate(SHOW_PANEL, "origin")
    numbers = {"wheel_radius": "0.2", "wheel_base": "0.5", "wheel_width": "0.06"}
    for name, text in tuple(numbers.items())[: (0, 1, 3)[steps - 1]]:
        tab.page.evaluate(SHOW_PANEL, "properties")
        tab.seek(name)
        box = tab.box(name)
        box.fill(text)
        box.press("Enter")
    tab.page.evaluate(SHOW_PANEL, "lessons")
    lessons.get_by_text(f"{steps} of 3 steps done").wait_for()


def take_class(browser: Browser) -> None:
    """A class: who is there, who asks, and who has done which step of a lesson."""
    words = ["demo", "--share", "--host", "127.0.0.1"]
    with (
        tempfile.TemporaryDirectory() as folder,
        running_studio(words, Path(folder)) as studio,
        tab_of(browser, studio, "light") as tab,
    ):
        students = [
            join(browser, studio, name) for name in ("Ada", "Emre", "Grace", "Jonas", "Mei")
        ]
        students[3].page.get_by_role("button", name="Ask for control").click()
        students[4].page.get_by_role("button", name="Raise hand").click()
        for student, steps in zip(students, (3, 1, 2, 0, 1), strict=True):
            if steps:
                find_the_wheel(student, steps)
        students[0].page.get_by_role("button", name="Hand in", exact=True).click()
        tab.page.evaluate(SHOW_PANEL, "people")
        tab.page.evaluate(SHOW_PANEL, "lessons")
        lessons = tab.page.get_by_role("region", name="Lessons", exact=True)
        lessons.get_by_role("searchbox").fill("find_the_wheel")
        lessons.get_by_role("button", name="find_the_wheel").click()
        lessons.get_by_role("button", name="Who has done it").click()
        lessons.get_by_role("row", name="Mei").wait_for()
        take(tab, "class-light")


def take_launch(browser: Browser) -> None:
    """What a launch file started: its processes, and what they print, below the robot."""
    with (
        running_router() as endpoint,
        tempfile.TemporaryDirectory() as folder,
    ):
        ws = robot_workspace(Path(folder) / "ws")
        words = ["open", str(ws), "--allow-run", str(ws), "--connect", endpoint, "--router", "off"]
        with (
            running_studio(words, Path(folder) / "data") as studio,
            tab_of(browser, studio, "dark") as tab,
        ):
            tab.page.evaluate(SHOW_PANEL, "launch")
            panel = tab.page.get_by_role("region", name="Launch", exact=True)
            files = panel.get_by_role("combobox", name="Launch file")
            files.select_option(label="show.launch.py")
            panel.get_by_role("button", name="Start", exact=True).click()
            panel.get_by_text("hello is said").first.wait_for()
            tab.page.get_by_text("cart.rviz is open").wait_for(state="hidden")
            take(tab, "launch-dark")


def main() -> None:
    """Take them all anew, or one kind: `python -m tests.support.readme_pictures live`."""
    kinds = {"all": take_all, "live": take_live, "class": take_class, "launch": take_launch}
    for browser in open_browser():
        for kind in sys.argv[1:] or kinds:
            kinds[kind](browser)


def take_all(browser: Browser) -> None:
    """One studio, a fresh tab for each picture."""
    with (
        tempfile.TemporaryDirectory() as folder,
        running_studio(["demo"], Path(folder)) as studio,
    ):
        for theme in ("dark", "light"):
            with tab_of(browser, studio, theme) as tab:
                take(tab, f"rover-{theme}")
        with tab_of(browser, studio, "dark") as tab:
            explain(tab)
            take(tab, "origin-dark")
        with tab_of(browser, studio, "light") as tab:
            compare(tab)
            take(tab, "variants-light")


if __name__ == "__main__":
    main()
