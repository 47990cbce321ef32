"""The Packages panel: nodes run and are edited, packages and nodes are made and taken back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.browser.test_launch_panel import run_tab
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]


def packages_of(tab: StudioPage) -> Locator:
    return tab.page.get_by_role("region", name="Packages", exact=True)


def test_a_node_runs_is_edited_in_source_and_is_started_again_on_save(
    browser: Browser, tmp_path: Path
):
    with run_tab(browser, tmp_path) as (tab, ws):
        panel, page = packages_of(tab), tab.page
        panel.get_by_role("button", name="Run speaker").click()
        panel.get_by_role("switch", name="Run speaker again on save").click()
        panel.get_by_role("button", name="Output of speaker").click()
        page.get_by_text("hello is said").first.wait_for()
        panel.get_by_role("button", name="speaker", exact=True).click()
        page.locator(".cm-line", has_text="hello is said").wait_for()
        assert page.locator(".cm-line .source-special", has_text="import").count() > 0
        page.locator(".cm-content").click()
        page.keyboard.press("Control+h")
        page.locator('.cm-search input[name="search"]').fill("hello is said")
        page.locator('.cm-search input[name="replace"]').fill("changed is said")
        page.get_by_role("button", name="replace all").click()
        page.keyboard.press("Escape")
        page.keyboard.press("Control+s")
        tab.agree_to_save()
        page.locator(".launching-lines").get_by_text("changed is said").first.wait_for()
        page.get_by_text("started again once by a save").wait_for()
        assert "changed is said" in (ws / "src/talk/talk/speaker.py").read_text()
        panel.get_by_role("button", name="Stop speaker").click()
        panel.get_by_role("button", name="Run speaker").wait_for()


def test_a_package_and_a_node_are_made_run_and_taken_back(browser: Browser, tmp_path: Path):
    with run_tab(browser, tmp_path) as (tab, ws):
        panel, page = packages_of(tab), tab.page
        panel.get_by_role("button", name="New package").click()
        window = page.get_by_role("dialog", name="New package")
        window.get_by_role("textbox", name="Name", exact=True).fill("greeting")
        window.get_by_role("button", name="Make").click()
        panel.locator(".packages-name", has_text="greeting").wait_for()
        panel.get_by_role("button", name="Add to greeting").click()
        page.get_by_role("menuitem", name="New node…").click()
        window = page.get_by_role("dialog", name="New node")
        window.get_by_role("textbox", name="Name", exact=True).fill("waver")
        window.get_by_role("button", name="Make").click()
        wait_until("the entry", lambda: "waver" in (ws / "src/greeting/setup.py").read_text())
        page.locator(".cm-line", has_text="import rclpy").first.wait_for()
        panel.get_by_role("button", name="Run waver").click()
        panel.get_by_role("button", name="Stop waver").click()
        panel.get_by_role("button", name="Run waver").wait_for()
        panel.get_by_role("button", name="Undo").click()
        panel.get_by_role("button", name="Run waver").wait_for(state="detached")
        assert "waver" not in (ws / "src/greeting/setup.py").read_text()
        assert not (ws / "src/greeting/greeting/waver.py").exists()
