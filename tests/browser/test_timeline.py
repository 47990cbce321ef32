"""The timeline: a bag is opened, dragged, stepped through, played, looped, and closed."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import pytest

from tests.support.bags import Told, write_mcap
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from playwright.sync_api import Browser, FloatRect, Locator

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

ROBOT: Final = '<robot name="post"><link name="base_link"/></robot>'
STEP_S: Final = 0.1
LENGTH_S: Final = 10.0
GAP_S: Final = (4.0, 5.0)
TRACK_Y_PX, RULER_Y_PX = 40, 6
OPEN_BAG: Final = """async (path) => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/time.js", script))).openBag(path);
}"""
MARKS: Final = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/time.js", script))).timeMarks.value?.counts ?? [];
}"""


def messages() -> list[Told]:
    """Ten a second, but for a gap."""
    times = [n * STEP_S for n in range(round(LENGTH_S / STEP_S) + 1)]
    return [
        Told("/chatter", round(one * 1e9), f"{one:.1f}")
        for one in times
        if not GAP_S[0] < one < GAP_S[1]
    ]


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
def shown_bag(browser: Browser, folder: Path) -> Generator[Timeline]:
    """A robot with a bag beside it, which is shown."""
    (folder / "post").mkdir()
    robot = folder / "post" / "post.urdf"
    robot.write_text(ROBOT)
    bag = write_mcap(folder / "post" / "drive.mcap", messages())
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


def test_a_bag_is_dragged_stepped_through_played_looped_and_closed(
    browser: Browser, tmp_path: Path
):
    with shown_bag(browser, tmp_path) as timeline:
        timeline.rests_at(0.0)
        drag_to_three_times(timeline)
        step_by_message(timeline)
        move_by_keys(timeline)
        see_the_gap(timeline)
        loop_and_play(timeline)
        timeline.button("Close").click()
        wait_until("no bag is shown", lambda: timeline.tab.page.locator(".timeline").count() == 0)


def drag_to_three_times(timeline: Timeline) -> None:
    """The time is where the pointer let it go: half a pixel is eight milliseconds."""
    pixel_s = LENGTH_S / timeline.box["width"]
    for from_s, to_s in ((0.5, 2.5), (2.5, 9.0), (9.0, 6.25)):
        timeline.drag(from_s, to_s, TRACK_Y_PX)
        timeline.rests_at(to_s, 2 * pixel_s)


def step_by_message(timeline: Timeline) -> None:
    """Comma and dot go from message to message, over the gap too."""
    timeline.tab.page.keyboard.press("Home")
    timeline.rests_at(0.0)
    timeline.tab.page.keyboard.press(".")
    timeline.rests_at(STEP_S)
    timeline.tab.page.locator(".timeline-topic").select_option("/chatter")
    timeline.button("Next message of /chatter").click()
    timeline.rests_at(2 * STEP_S)
    timeline.tab.page.keyboard.press(",")
    timeline.rests_at(STEP_S)
    timeline.slider.focus()
    for _ in range(4):  # seconds
        timeline.tab.page.keyboard.press("ArrowRight")
    timeline.rests_at(4.1)
    timeline.tab.page.keyboard.press(".")
    timeline.rests_at(GAP_S[1])


def move_by_keys(timeline: Timeline) -> None:
    """As a slider; what it says is the time."""
    timeline.slider.focus()
    timeline.tab.page.keyboard.press("Home")
    timeline.tab.page.keyboard.press("Shift+ArrowRight")
    timeline.rests_at(LENGTH_S)
    timeline.tab.page.keyboard.press("Alt+ArrowLeft")
    timeline.rests_at(LENGTH_S - 0.1)
    wait_until(
        "the slider says it",
        lambda: (timeline.slider.get_attribute("aria-valuetext") or "").startswith("0:09.9"),
    )


def see_the_gap(timeline: Timeline) -> None:
    """Where the topic has no message, no mark is drawn; the last one is where the range ends."""
    page = timeline.tab.page
    wait_until("marks", lambda: sum(page.evaluate(MARKS)) >= len(messages()) - 1)
    counts = page.evaluate(MARKS)
    middle = counts[round(len(counts) * 0.42) : round(len(counts) * 0.48)]
    assert len(middle) > 10
    assert sum(middle) == 0


def loop_and_play(timeline: Timeline) -> None:
    """A drag on the ruler loops a part; Space plays it, and the time stays within it."""
    pixel_s = LENGTH_S / timeline.box["width"]
    timeline.drag(1.0, 2.0, RULER_Y_PX)
    timeline.button("End the loop").wait_for()
    timeline.drag(1.8, 1.9, TRACK_Y_PX)
    timeline.rests_at(1.9, 2 * pixel_s)
    timeline.tab.page.keyboard.press("Space")
    timeline.button("Pause").wait_for()
    wait_until("it has begun again", lambda: timeline.shown_s() < 1.5)
    assert 1.0 - 2 * pixel_s <= timeline.shown_s() <= 2.0 + 2 * pixel_s
    timeline.tab.page.keyboard.press("Space")
    timeline.button("Play").wait_for()
    timeline.button("End the loop").click()
    timeline.button("Loop what is seen").wait_for()
