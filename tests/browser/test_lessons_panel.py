"""A lesson: found, read beside its demos, its links followed; a viewer starts nothing of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, studio_page
from tests.support.wire import running_router

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(600)]


def lessons_of(tab: StudioPage) -> Locator:
    """Bring the panel to the front, with the lesson of the listener, found by a word of it."""
    tab.page.evaluate(SHOW_PANEL, "lessons")
    panel = tab.page.get_by_role("region", name="Lessons", exact=True)
    panel.get_by_role("searchbox").fill("helloworld_sub")
    panel.get_by_role("button", name="listener").click()
    return panel


def start_both(panel: Locator) -> None:
    panel.get_by_text("Not connected with ROS 2.").wait_for()
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


def a_viewer_reads_and_starts_nothing(browser: Browser, studio: RunningStudio) -> None:
    assert studio.process.stdout is not None
    address = studio.process.stdout.readline().removeprefix("Viewer: ").strip()
    context = studio_context(browser)
    try:
        viewer = StudioPage(context.new_page())
        viewer.open(address)
        panel = lessons_of(viewer)
        panel.get_by_text("Only the presenter starts and stops demos.").wait_for()
        panel.get_by_text("Has run for").first.wait_for()
        panel.get_by_role("log").get_by_text("I heard").wait_for()
        assert panel.get_by_role("button", name="Stop").count() == 0
        assert panel.get_by_role("button", name="Start").count() == 0
        assert viewer.errors == []
    finally:
        context.close()


def stop_one_and_then_all(panel: Locator) -> None:
    panel.get_by_role("button", name="Stop listener").click()
    panel.get_by_role("button", name="Start listener").wait_for()
    panel.get_by_text("Stopped").wait_for()
    panel.get_by_role("button", name="Back to the list").click()
    panel.get_by_text("1 demo runs").wait_for()
    panel.get_by_role("button", name="Stop all").click()
    panel.get_by_text("1 demo runs").wait_for(state="hidden")
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
            panel = lessons_of(tab)
            start_both(panel)
            follow_a_link_to_the_topic(tab, panel)
            a_viewer_reads_and_starts_nothing(browser, studio)
            tab.page.evaluate(SHOW_PANEL, "lessons")
            stop_one_and_then_all(panel)
            assert tab.errors == []
