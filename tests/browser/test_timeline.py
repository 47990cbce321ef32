"""The timeline: a bag is opened, dragged, stepped through, played, looped, and closed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pytest

from tests.support.studio_page import wait_until
from tests.support.timeline import (
    GAP_S,
    LENGTH_S,
    RULER_Y_PX,
    STEP_S,
    TRACK_Y_PX,
    Timeline,
    messages,
    shown_bag,
)

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

MARKS: Final = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/time.js", script))).timeMarks.value?.counts ?? [];
}"""


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
