"""A student's workspace in the page: a line of the course is pasted, and its nodes run."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.support.command_line import started
from tests.support.course_workspaces import (
    chatter_and_r2d2,
    first_nodes,
    quotes_and_jerry,
    radio_station,
    week_of_nodes,
)
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

ROBOT = '<robot name="r2d2"><link name="axis"/></robot>\n'


def test_a_pasted_line_runs_a_node_of_the_workspace_and_its_topic_is_seen(
    browser: Browser, tmp_path: Path
):
    made = chatter_and_r2d2(tmp_path / "ros2_ws", ROBOT)
    with running_router() as endpoint:
        words = ["open", str(made.folder), "--connect", endpoint, "--router", "off"]
        words += ["--allow-run", str(made.folder)]
        with running_studio(words, tmp_path / "data") as studio:
            context = studio_context(browser)
            tab = StudioPage(context.new_page())
            tab.page.goto(studio.url)
            # It stands there once the robot has come, after which nothing is arranged anew.
            tab.page.get_by_role("tab", name="Packages").wait_for()
            palette = tab.page.locator(".palette-item")
            tab.page.evaluate(SHOW_PANEL, "packages")
            tab.page.get_by_text("python_pkg_name").first.wait_for()
            tab.page.keyboard.press("Control+k")
            tab.page.keyboard.type("$ ros2 run python_pkg_name publisher_node")
            wait_until("it is offered", lambda: "publisher_node" in palette.first.inner_text())
            tab.page.keyboard.press("Enter")
            tab.page.get_by_text('Publishing: "Hello World"').first.wait_for()
            tab.page.evaluate(SHOW_PANEL, "topics")
            tab.page.get_by_text("/chatter").first.wait_for()
            where = ("--package-path", str(made.src))
            line = ("run", "python_pkg_name", "subscriber_node", *where)
            with started(endpoint, *line) as hears:
                hears.wait_for('I heard: "Hello World"')
            assert tab.errors == []
            context.close()


class Run(NamedTuple):
    """A node of a seed, and what it brings: a topic or a service, listed in a panel."""

    package: str
    executable: str
    panel: str
    name: str


RUNS = (
    Run("radio_station", "service_server", "services", "/get_now_playing"),
    Run("py_pkg_using_messages", "amazing_quote_publisher_node", "topics", "/amazing_quote"),
    Run("my_py_pkg", "my_tiny_pub", "topics", "/number"),
    Run("python_pkg_name", "publisher_node", "topics", "/chatter"),
    Run("my_robot_package", "service_server_node", "services", "/add_two_ints"),
)


def test_a_node_of_each_text_runs_by_its_button_and_its_topic_or_service_is_seen(
    browser: Browser, tmp_path: Path
):
    ws = tmp_path / "ros2_ws"
    for make in (radio_station, quotes_and_jerry, first_nodes, week_of_nodes):
        make(ws)
    chatter_and_r2d2(ws, ROBOT)
    with running_router() as endpoint:
        words = ["open", str(ws), "--connect", endpoint, "--router", "off", "--allow-run", str(ws)]
        with running_studio(words, tmp_path / "data") as studio:
            context = studio_context(browser)
            tab = StudioPage(context.new_page())
            tab.page.goto(studio.url)
            # It stands there once the robot has come, after which nothing is arranged anew.
            tab.page.get_by_role("tab", name="Packages").wait_for()
            for run in RUNS:
                tab.page.evaluate(SHOW_PANEL, "packages")
                header = tab.page.locator(".packages-name").filter(
                    has=tab.page.locator("strong").get_by_text(run.package, exact=True)
                )
                header.wait_for()
                if header.get_attribute("aria-expanded") == "false":
                    header.click()
                package = tab.page.locator(".packages-package").filter(has=header)
                row = package.locator(".packages-executable").filter(
                    has=tab.page.get_by_text(run.executable, exact=True)
                )
                row.get_by_role("button", name=run.executable).last.click()
                tab.page.evaluate(SHOW_PANEL, run.panel)
                tab.page.get_by_text(run.name, exact=True).first.wait_for()
            assert tab.errors == []
            context.close()
