"""A lesson: found, read beside its demos, its links followed; a viewer starts nothing of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pytest

from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, studio_page, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator, ViewportSize

    from tests.support.server import RunningStudio

SMALL: Final[ViewportSize] = {"width": 1000, "height": 600}
"""For R2D2 is drawn all the time."""
_MOVED_M = """() => {
  const { nodeRefFromName } = document.querySelector("iframe").contentWindow.__viserMutable;
  const name = Object.keys(nodeRefFromName).find((one) => /head\\/visual/.test(one));
  const head = name && nodeRefFromName[name];
  if (!head) return 0;
  head.updateWorldMatrix(true, false);
  const [x, y, z] = head.matrixWorld.elements.slice(12, 15);
  window.headBefore ??= [x, y, z];
  const [x0, y0, z0] = window.headBefore;
  return Math.hypot(x - x0, y - y0, z - z0);
}"""

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(600)]


def lessons_of(tab: StudioPage) -> Locator:
    """Bring the panel to the front, with the lesson of the listener, found by a word of it."""
    tab.page.evaluate(SHOW_PANEL, "lessons")
    panel = tab.page.get_by_role("region", name="Lessons", exact=True)
    panel.get_by_role("searchbox").fill("helloworld_sub")
    panel.get_by_role("button", name="listener").click()
    return panel


def start_both(panel: Locator) -> None:
    panel.get_by_text("Not connected to ROS 2.").wait_for()
    assert panel.get_by_role("button", name="Start listener").is_disabled()
    panel.get_by_role("button", name="Connect").click()
    panel.get_by_role("button", name="Start all 2").click()
    for demo in ("talker", "listener"):
        panel.get_by_role("button", name=f"Stop {demo}").wait_for()
    panel.get_by_role("log").get_by_text("I heard").wait_for()


def follow_a_link_to_the_topic(tab: StudioPage, panel: Locator) -> None:
    panel.get_by_role("button", name="talker", exact=True).first.click()
    panel.get_by_role("log").get_by_text("Publishing").wait_for()
    panel.get_by_role("article").get_by_role("button", name="Topics", exact=True).click()
    topics = tab.page.get_by_role("region", name="Topics", exact=True)
    topics.get_by_text("Hello World", exact=True).wait_for()
    assert panel.get_by_role("article").is_visible()  # beside it, not in its place


def read_its_code(panel: Locator) -> None:
    panel.get_by_text("Code of talker", exact=True).click()
    panel.get_by_role("region", name="Text of talker.py").get_by_text("create_publisher").wait_for()


def see_r2d2_drive(tab: StudioPage, panel: Locator) -> None:
    """The end of the lesson about it, as its text says."""
    panel.get_by_role("searchbox").fill("state_publisher")
    panel.get_by_role("button", name="state_publisher").first.click()
    panel.get_by_role("button", name="Start state_publisher").click()
    panel.get_by_role("button", name="Stop state_publisher").wait_for()
    panel.get_by_role("button", name="Open the R2D2 model").click()
    wait_until("R2D2 is drawn", lambda: "r2d2" in tab.page.title() and tab.has_drawn_robot())
    frame = tab.page.get_by_role("textbox", name="Fixed frame")
    frame.fill("odom")
    frame.press("Enter")
    panel.get_by_role("article").get_by_role("button", name="Joints").click()
    joints = tab.page.get_by_role("region", name="Joints", exact=True)
    joints.get_by_label("Joints are moved by").select_option("/joint_states")
    swivel = joints.get_by_role("textbox", name="swivel")
    before = swivel.input_value()
    wait_until("the head turns", lambda: swivel.input_value() != before)
    wait_until("R2D2 goes", lambda: moved_m(tab) > 0.05)
    panel.get_by_role("button", name="Stop state_publisher").click()
    panel.get_by_role("button", name="Start state_publisher").wait_for()


def moved_m(tab: StudioPage) -> float:
    """How far the head of R2D2 is from where it was when this was first asked."""
    return float(tab.page.evaluate(_MOVED_M))


def a_viewer_reads_and_starts_nothing(browser: Browser, studio: RunningStudio) -> None:
    address = studio.viewer_url
    context = studio_context(browser)
    try:
        viewer = StudioPage(context.new_page())
        viewer.open(address, view=False)
        panel = lessons_of(viewer)
        panel.get_by_text("Only the presenter can start and stop demos.").wait_for()
        panel.get_by_text("Running for").first.wait_for()
        panel.get_by_role("log").get_by_text("I heard").wait_for()
        assert panel.get_by_role("button", name="Stop").count() == 0
        assert panel.get_by_role("button", name="Start").count() == 0
        assert viewer.errors == []
    finally:
        context.close()


def stop_one_and_then_all(panel: Locator) -> None:
    panel.get_by_role("button", name="Stop listener").click()
    panel.get_by_role("button", name="Start listener").wait_for()
    panel.get_by_text("Stopped", exact=True).wait_for()
    panel.get_by_role("button", name="Back to the list").click()
    panel.get_by_text("1 demo running").wait_for()
    panel.get_by_role("button", name="Stop all").click()
    panel.get_by_text("1 demo running").wait_for(state="hidden")
    assert panel.get_by_role("img", name="Runs").count() == 0


def test_a_lesson_is_read_beside_its_demos_which_start_and_stop_there(
    browser: Browser, tmp_path: Path
):
    with running_router() as endpoint:
        words = ["demo", "--viewer-link", "--connect", endpoint, "--router", "off"]
        with (
            running_studio(words, tmp_path / "data") as studio,
            studio_page(browser, studio) as tab,
        ):
            tab.page.set_viewport_size(SMALL)
            panel = lessons_of(tab)
            start_both(panel)
            follow_a_link_to_the_topic(tab, panel)
            read_its_code(panel)
            a_viewer_reads_and_starts_nothing(browser, studio)
            tab.page.evaluate(SHOW_PANEL, "lessons")
            stop_one_and_then_all(panel)
            see_r2d2_drive(tab, panel)
            assert tab.errors == []
