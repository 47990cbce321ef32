"""A link to a moment: who opens it sees the bag at that time, and the robot as it was looked at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pytest

from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until
from tests.support.timeline import OPEN_BAG, TRACK_Y_PX, Timeline, write_chatter

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

LOOK: Final = """async (pose) => {
  const script = document.querySelector('script[type="module"]').src;
  const { viewport } = await import(new URL("../model/viewport.js", script));
  const { part } = await import(new URL("../model/selection.js", script));
  if (pose && viewport.value) viewport.value.setCamera(pose);
  const camera = viewport.value?.getCamera();
  return camera && { eye: camera.position.map((one) => Math.round(one * 1e6)), part: part.value };
}"""
ROBOT: Final = """<robot name="post"><link name="base_link">
  <visual><geometry><box size="0.5 0.5 1"/></geometry></visual></link></robot>"""
POSE: Final = {"position": [1.25, -2.5, 0.75], "target": [0, 0, 0.25]}
EYE: Final = [1_250_000, -2_500_000, 750_000]


def test_a_link_leads_to_the_moment_the_camera_and_the_selection(browser: Browser, tmp_path: Path):
    robot = tmp_path / "post" / "post.urdf"
    robot.parent.mkdir()
    robot.write_text(ROBOT)
    bag = write_chatter(robot.parent / "drive.mcap")
    context = studio_context(browser)
    with running_studio(["open", str(robot), "--router", "off"], tmp_path / "data") as studio:
        tab = StudioPage(context.new_page())
        tab.open(studio.url)
        tab.page.evaluate(OPEN_BAG, str(bag))
        timeline = Timeline(tab)
        timeline.slider.wait_for()
        timeline.drag(0.5, 6.25, TRACK_Y_PX)
        wait_until("the drag to end", lambda: timeline.shown_s() > 6.0)
        at_s = timeline.shown_s()
        tab.page.get_by_role("treeitem", name="base_link").first.click()
        wait_until("the link to be selected", lambda: look(tab)["part"] == "link:base_link")
        look(tab, POSE)
        link = link_of(tab)
        other = StudioPage(context.new_page())
        other.page.goto(link)
        dialog = other.page.get_by_role("dialog", name="from this link?")
        dialog.get_by_text("a moment of the bag drive").wait_for()
        dialog.get_by_role("button", name="Open", exact=True).click()
        other.page.wait_for_url("**/d/post-2")
        Timeline(other).rests_at(at_s)
        wait_until("it to look so", lambda: look(other) == {"eye": EYE, "part": "link:base_link"})
        assert (tab.errors, other.errors) == ([], [])
    context.close()


def link_of(tab: StudioPage) -> str:
    """The link that the page offers to copy."""
    tab.page.get_by_role("button", name="Documents").click()
    tab.page.get_by_role("menuitem", name="Copy link").click()
    dialog = tab.page.get_by_role("dialog")
    dialog.get_by_text("The bag drive").wait_for()
    return dialog.get_by_label("Link", exact=True).input_value()


def look(tab: StudioPage, pose: dict[str, Any] | None = None) -> dict[str, Any]:
    """Where a page looks from, um, and what is selected; empty: there is no view yet."""
    return tab.page.evaluate(LOOK, pose) or {}
