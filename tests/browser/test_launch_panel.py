"""The Launch panel: a launch file is planned by its arguments, started, read and stopped."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from tests.support.panel_pictures import SHOW_PANEL
from tests.support.run_studio import add_robot, workspace
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]


@contextmanager
def run_tab(
    browser: Browser, folder: Path, *, allowed: bool = True
) -> Generator[tuple[StudioPage, Path]]:
    """A tab at a studio that shows a workspace without a robot; the workspace."""
    ws = workspace(folder / "ws")
    with router_at(free_endpoint()) as router:
        arguments = ["open", str(ws), "--connect", router.endpoint.text, "--router", "off"]
        arguments += ["--allow-run", str(ws)] if allowed else []
        with running_studio(arguments, folder / "data") as studio:
            context = studio_context(browser)
            tab = StudioPage(context.new_page())
            tab.page.goto(studio.url)
            yield tab, ws
            assert tab.errors == []
            context.close()


def test_a_launch_file_is_planned_started_read_and_stopped(browser: Browser, tmp_path: Path):
    with run_tab(browser, tmp_path) as (tab, _):
        panel = tab.page.get_by_role("region", name="Launch", exact=True)
        panel.get_by_text("/hall/one").wait_for()
        panel.get_by_text("does not hold").wait_for()
        panel.get_by_role("combobox", name="name", exact=True).select_option("two")
        panel.get_by_text("/hall/two").wait_for()
        panel.get_by_role("switch", name="loud").click()
        panel.get_by_text("does not hold").wait_for(state="detached")
        panel.get_by_role("button", name="Graph", exact=True).click()
        panel.get_by_role("button", name="Topic /hall/heard").wait_for()
        panel.get_by_role("button", name="Start", exact=True).click()
        panel.get_by_text("hello is said").first.wait_for()
        output = panel.get_by_role("log", name="Output")
        panel.get_by_role("button", name="stderr", exact=True).click()
        output.get_by_text("hello is said").first.wait_for(state="detached")
        output.get_by_text("with a warning").first.wait_for()
        panel.get_by_role("button", name="/second").click()
        wait_until("one process alone", lambda: output.locator(".launching-text").count() == 1)
        panel.locator(".launching-head").get_by_role("button", name="Stop").click()
        panel.get_by_text("Ended with code 0").wait_for()


def test_rviz2_of_a_launch_opens_its_config_and_the_robot_of_the_plan_opens_as_a_document(
    browser: Browser, tmp_path: Path
):
    with run_tab(browser, tmp_path) as (tab, ws):
        page = tab.page
        panel = page.get_by_role("region", name="Launch", exact=True)
        panel.get_by_text("/hall/one").wait_for()
        add_robot(ws)
        files = panel.get_by_role("combobox", name="Launch file")
        files.locator("option", has_text="show.launch.py").wait_for(state="attached")
        files.select_option(label="show.launch.py")
        panel.get_by_text("length:=0.8").wait_for()
        panel.get_by_role("button", name="Start", exact=True).click()
        page.get_by_text("cart.rviz is open").wait_for()
        assert page.get_by_role("dialog").count() == 0, "nothing stands over what runs"
        panel.get_by_text("shown in the page").wait_for()
        page.evaluate(SHOW_PANEL, "displays")
        page.get_by_role("treeitem", name="Frames of the cart").wait_for()
        # Another file is chosen to be looked at, and what runs is of this one.
        files.select_option(label="hall.launch.py")
        panel.get_by_text("/hall/one").wait_for()
        files.select_option(label="show.launch.py")
        panel.get_by_role("button", name="Stop", exact=True).click()
        panel.get_by_role("button", name="Start", exact=True).wait_for()
        panel.get_by_role("textbox", name="length", exact=True).fill("0.6")
        panel.get_by_text("length:=0.6").wait_for()
        panel.get_by_role("button", name="Open robot").click()
        page.get_by_role("button", name="cart.xacro").first.wait_for()
        page.evaluate(SHOW_PANEL, "properties")
        box = tab.box("length")
        box.wait_for()
        wait_until("the value of the plan", lambda: box.input_value() == "0.6")
        # Beside a robot whose folder may be run the two panels have their tabs.
        for name in ("Packages", "Launch"):
            page.get_by_role("tab", name=name, exact=True).wait_for(state="attached")


def test_without_the_option_the_panel_says_what_to_do(browser: Browser, tmp_path: Path):
    with run_tab(browser, tmp_path, allowed=False) as (tab, ws):
        tab.page.evaluate(SHOW_PANEL, "launch")
        panel = tab.page.get_by_role("region", name="Launch", exact=True)
        panel.get_by_text(f"studio open {ws} --allow-run {ws}").wait_for()
        assert panel.get_by_role("button", name="Start", exact=True).count() == 0
