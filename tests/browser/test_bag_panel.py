"""The Bag panel: what a bag holds, a topic marked, and a form to record the next."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pytest
from axe_playwright_python.base import AXE_SCRIPT

from tests.support.panel_pictures import SHOW_PANEL
from tests.support.timeline import messages, shown_bag

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Page

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

PREPARE: Final = """async (line) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../model/recording.js", script))).prepareRecording(line);
}"""
AXE: Final = """async () => {
  const places = { include: [[".timeline"], [".bag"]] };
  return (await axe.run(places)).violations;
}"""
FORM: Final = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/recording.js", script))).recordForm.value;
}"""


def test_the_contents_of_a_bag_are_listed_and_a_topic_is_marked(browser: Browser, tmp_path: Path):
    with shown_bag(browser, tmp_path) as timeline:
        page = timeline.tab.page
        page.evaluate(SHOW_PANEL, "bag")
        panel = page.get_by_role("region", name="Bag", exact=True)
        panel.get_by_text("drive.mcap", exact=True).first.wait_for()
        panel.get_by_text("0:10.000").wait_for()
        row = panel.get_by_role("row", name="/chatter")
        assert str(len(messages())) in row.inner_text()
        row.get_by_role("button", name="Mark /chatter on the timeline").click()
        assert page.locator(".timeline-topic").input_value() == "/chatter"
        nothing_is_in_the_way(page)
        a_line_fills_the_form(page)
        nothing_is_in_the_way(page)


def nothing_is_in_the_way(page: Page) -> None:
    """axe finds nothing wrong in the panel and on the timeline."""
    page.evaluate(AXE_SCRIPT)
    found = page.evaluate(AXE)
    assert [(one["id"], [node["html"] for node in one["nodes"]]) for one in found] == []


def a_line_fills_the_form(page: Page) -> None:
    """What a pasted command line says stands in the form."""
    page.evaluate(PREPARE, {"topics": ["/tf", "/scan"], "storage": "sqlite3", "name": "drive"})
    form = page.evaluate(FORM)
    assert form["which"] == "topics"
    assert form["topics"] == ["/tf", "/scan"]
    assert form["storage"] == "sqlite3"
    assert form["name"] == "drive"
    record = page.get_by_role("button", name="Record", exact=True)
    assert record.get_attribute("aria-pressed") == "true"
