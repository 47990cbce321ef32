"""Students' own nodes, from the switch in the presenter's page to the lists in the students'."""

from __future__ import annotations

from contextlib import ExitStack, closing
from typing import TYPE_CHECKING

import pytest

from tests.support.classmates import Classmate
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.student_nodes import OwnNode
from tests.support.studio_page import StudioPage, studio_context

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network]


def student(held: ExitStack, browser: Browser, studio: RunningStudio, name: str) -> StudioPage:
    """The page of somebody who has joined, with the window of their own nodes open."""
    joined = held.enter_context(closing(Classmate(f"{studio.origin}/")))
    joined.join(name, studio.class_code)
    context = studio_context(browser)
    held.callback(context.close)
    cookies = dict(joined.client.cookies.items())
    context.add_cookies(
        [{"name": one, "value": value, "url": studio.origin} for one, value in cookies.items()]
    )
    tab = StudioPage(context.new_page())
    tab.open(f"{studio.origin}/", view=False)
    tab.page.get_by_role("button", name="My ROS nodes").click()
    tab.page.get_by_text("No node yet").wait_for()
    return tab


def graph_of_copy(tab: StudioPage) -> Locator:
    """The panel of the graph, on a copy of one's own."""
    tab.page.keyboard.press("Escape")
    tab.page.get_by_role("button", name="My copy", exact=True).click()
    tab.page.wait_for_url("**/d/rover~*")
    tab.page.locator(".scene").wait_for()
    tab.page.wait_for_load_state()
    tab.page.evaluate(SHOW_PANEL, "graph")
    return tab.page.get_by_role("region", name="Node graph", exact=True)


def test_two_students_copy_a_line_and_each_sees_the_nodes_of_their_own(
    browser: Browser, tmp_path: Path
):
    words = ["demo", "--share", "--host", "127.0.0.1"]
    with running_studio(words, tmp_path / "data") as studio, ExitStack() as held:
        context = studio_context(browser)
        held.callback(context.close)
        presenter = StudioPage(context.new_page())
        presenter.open(studio.url, view=False)
        presenter.page.locator(".share-button").click()
        switch = presenter.page.get_by_role("switch", name="Students' own nodes")
        switch.click()
        presenter.page.get_by_text("0 of 60 domains given out").wait_for()
        ada, bob = (student(held, browser, studio, name) for name in ("Ada", "Bob"))
        presenter.page.get_by_text("2 of 60 domains given out").wait_for()
        line = ada.page.get_by_label("Line to paste").input_value()
        assert line != bob.page.get_by_label("Line to paste").input_value()
        held.enter_context(closing(OwnNode(line, "ada_talks")))
        ada.page.get_by_role("listitem").filter(has_text="/ada_talks").wait_for()
        ada.page.get_by_role("row").filter(has_text="/temperature").wait_for()
        bob.page.get_by_text("No node yet").wait_for()
        graph = graph_of_copy(ada)
        graph.get_by_role("listitem").filter(has_text="/ada_talks").wait_for()
        ada.page.get_by_role("button", name="My ROS nodes").click()
        switch.click()
        presenter.page.get_by_role("button", name="Switch access off").click()
        for one in (ada, bob):
            one.page.get_by_text("Own nodes cannot join now").wait_for()
        for one in (presenter, ada, bob):
            assert one.errors == []
