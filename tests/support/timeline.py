"""A bag beside a robot, shown in a browser, and its timeline in the words of who moves it."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from tests.support.bags import Told, write_mcap
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from playwright.sync_api import Browser, FloatRect, Locator

ROBOT: Final = '<robot name="post"><link name="base_link"/></robot>'
STEP_S: Final = 0.1
LENGTH_S: Final = 10.0
GAP_S: Final = (4.0, 5.0)
TRACK_Y_PX: Final = 40
RULER_Y_PX: Final = 6
OPEN_BAG: Final = """async (path) => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/time.js", script))).openBag(path);
}"""


def messages() -> list[Told]:
    """Ten a second, but for a gap."""
    times = [n * STEP_S for n in range(round(LENGTH_S / STEP_S) + 1)]
    return [
        Told("/chatter", round(one * 1e9), f"{one:.1f}")
        for one in times
        if not GAP_S[0] < one < GAP_S[1]
    ]


def write_chatter(file: Path) -> Path:
    """Write a bag of those."""
    return write_mcap(file, messages())


class Timeline:
    """The bar, in the words of who moves it."""

    def __init__(self, tab: StudioPage) -> None:
        self.tab = tab
        self.slider = tab.page.get_by_role("slider", name="Time", exact=True)

    @property
    def box(self) -> FloatRect:
        """Where the ruler is."""
        box = self.slider.bounding_box()
        assert box is not None
        return box

    def shown_s(self) -> float:
        """Return the time that is shown."""
        text = self.tab.page.locator(".timeline-clock [data-time]").get_attribute("data-time")
        return float(text or "nan")

    def x_of(self, at_s: float) -> float:
        """Return where a time is, while all of it is seen."""
        return self.box["x"] + self.box["width"] * at_s / LENGTH_S

    def drag(self, from_s: float, to_s: float, y_px: float) -> None:
        """Press, move in steps, and release."""
        mouse, y = self.tab.page.mouse, self.box["y"] + y_px
        mouse.move(self.x_of(from_s), y)
        mouse.down()
        mouse.move(self.x_of(to_s), y, steps=6)
        mouse.up()

    def rests_at(self, at_s: float, within_s: float = 1e-6) -> None:
        """Wait until that time is shown."""
        wait_until(f"{at_s} s is shown", lambda: abs(self.shown_s() - at_s) <= within_s)

    def button(self, name: str) -> Locator:
        """Return a button of the bar."""
        return self.tab.page.locator(".timeline").get_by_role("button", name=name)


@contextmanager
def shown_bag(
    browser: Browser, folder: Path, write: Callable[[Path], Path] = write_chatter
) -> Generator[Timeline]:
    """A robot with a bag beside it, which is shown; `write` makes the bag's file."""
    (folder / "post").mkdir()
    robot = folder / "post" / "post.urdf"
    robot.write_text(ROBOT)
    bag = write(folder / "post" / "drive.mcap")
    with running_studio(["open", str(robot), "--router", "off"], folder / "data") as studio:
        context = studio_context(browser)
        tab = StudioPage(context.new_page())
        tab.open(studio.url, view=False)
        assert tab.page.locator(".timeline").count() == 0
        tab.page.evaluate(OPEN_BAG, str(bag))
        timeline = Timeline(tab)
        timeline.slider.wait_for()
        yield timeline
        assert tab.errors == []
        context.close()
