"""A robot of very many links: the page stays quick, for only what is in view is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.large_robots import robot_of_links
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Page

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.sweep, pytest.mark.timeout(300)]

LINKS = 3000
MOST_ELEMENTS = 6000
_COUNT = "document.getElementsByTagName('*').length"
_IN_VIEW = """row => {
  const { top, bottom } = row.getBoundingClientRect();
  const around = row.closest(".scroll, .tree").getBoundingClientRect();
  return top >= around.top - 1 && bottom <= around.bottom + 1;
}"""


def show(page: Page, panel: str) -> None:
    page.get_by_role("tab", name=panel).click()
    wait_until(
        f"{panel} to be drawn",
        lambda: (
            page.locator(f"section.panel-body[aria-label='{panel}'] >> visible=true").count() == 1
        ),
    )


def test_of_thousands_of_links_only_those_in_view_are_drawn_and_keys_reach_all(
    browser: Browser, tmp_path: Path
):
    path = robot_of_links(tmp_path, LINKS)
    context = studio_context(browser)
    with running_studio(["open", str(path)], tmp_path / "data") as studio:
        tab = StudioPage(context.new_page())
        page = tab.page
        page.set_default_timeout(60_000)
        page.goto(studio.url)
        first = page.get_by_role("treeitem", name="l0", exact=True)
        first.wait_for()
        # The root has all others below it, whether they are drawn or not.
        second = page.get_by_role("treeitem", name="l1", exact=True)
        assert second.get_attribute("aria-setsize") == str(LINKS - 1)
        first.focus()
        page.keyboard.press("End")
        last = page.get_by_role("treeitem", name=f"l{LINKS - 1}", exact=True)
        wait_until(
            "the last link to have the focus",
            lambda: last.count() == 1 and last.evaluate("one => one === document.activeElement"),
        )
        wait_until("the last link to be in view", lambda: bool(last.evaluate(_IN_VIEW)))
        page.keyboard.press("Enter")
        show(page, "Joints")
        joint = page.get_by_role("group", name=f"j{LINKS - 1}", exact=True)
        wait_until(
            "its joint to be in view", lambda: joint.count() == 1 and joint.evaluate(_IN_VIEW)
        )
        page.get_by_role("searchbox", name="Filter displays and links").fill("l1234")
        page.get_by_role("treeitem", name="l1234", exact=True).wait_for()
        for panel in ("Problems", "Masses", "Properties"):
            show(page, panel)
            assert page.evaluate(_COUNT) < MOST_ELEMENTS, panel
        assert tab.errors == []
    context.close()
