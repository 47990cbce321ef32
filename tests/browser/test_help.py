"""The help: reached from every panel and window, read and searched by keys alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.panel_pictures import PANEL_IDS, SHOW_PANEL
from tests.support.studio_page import StudioPage, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Locator

    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

_FOCUSED_CLASS = "() => document.activeElement.className"
_FOCUSED_TITLE = "() => document.activeElement.title"
_FOCUSED = "() => document.activeElement?.closest('.dv-tab, button')?.textContent?.trim()"
_CLOSE = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("help.js", script))).help.value = null;
}"""
_HAS_PICTURE = "one => one.complete && one.naturalWidth > 0"


@pytest.fixture(scope="module")
def opened(shared: SharedTab) -> StudioPage:
    """One tab for all tests of the file."""
    shared.anew()
    return shared.opened(view=False)


@pytest.fixture
def tab(opened: StudioPage) -> Iterator[StudioPage]:
    """The same; the help is closed after each test."""
    yield opened
    opened.page.evaluate(_CLOSE)
    opened.page.locator("dialog").wait_for(state="detached")
    assert opened.errors == []


def sheet(tab: StudioPage, title: str) -> Locator:
    """The help, once it shows the page of this title and its text."""
    found = tab.page.get_by_role("dialog", name=title, exact=True)
    found.locator("article p, nav").first.wait_for()
    return found


def title_of(tab: StudioPage) -> str:
    """The title of the page that the help shows."""
    return tab.page.locator("dialog.help h2").inner_text()


def test_every_panel_has_help_with_a_picture_one_key_away(tab: StudioPage):
    for panel in tab.page.evaluate(PANEL_IDS):
        tab.page.evaluate(SHOW_PANEL, panel)
        tab.page.keyboard.press("F1")
        picture = sheet(tab, title_of(tab)).get_by_role("img")
        wait_until(f"the picture of {panel}", lambda one=picture: one.evaluate(_HAS_PICTURE))
        tab.page.keyboard.press("Escape")
        wait_until("the help to be gone", lambda: tab.page.locator("dialog.help").count() == 0)


def test_help_is_opened_read_searched_and_left_by_keys_alone(tab: StudioPage):
    page = tab.page
    page.get_by_role("tab", name="Properties", exact=True).focus()
    page.keyboard.press("F1")
    help_sheet = sheet(tab, "Properties")
    wait_until("the focus on its text", lambda: page.evaluate(_FOCUSED_CLASS) == "help-text")
    left = help_sheet.bounding_box()
    assert left is not None
    assert left["x"] < 100, "the panel at the right edge is not covered by its help"
    help_sheet.get_by_role("button", name="What is xacro?").focus()
    page.keyboard.press("Enter")
    sheet(tab, "What is xacro?").get_by_text("Written by hand").wait_for()
    page.keyboard.press("Alt+ArrowLeft")
    sheet(tab, "Properties").get_by_role("searchbox").focus()
    page.keyboard.type("centre of mass")
    page.get_by_role("list", name="Search the help").get_by_role("button").first.wait_for()
    page.keyboard.press("Enter")
    sheet(tab, "Masses")
    page.keyboard.press("Escape")
    wait_until("the help to be gone", lambda: page.locator("dialog.help").count() == 0)
    wait_until("the focus where it was", lambda: page.evaluate(_FOCUSED) == "Properties")


def test_the_button_of_a_panel_and_its_menu_open_its_help(tab: StudioPage):
    page = tab.page
    page.get_by_role("tab", name="Joints").click()
    page.get_by_role("button", name="Help: Joints").click()
    sheet(tab, "Joints").get_by_role("button", name="Close the help").click()
    wait_until("the focus back", lambda: page.evaluate(_FOCUSED_TITLE) == "Help: Joints")
    page.get_by_role("tab", name="Displays").click(button="right")
    page.get_by_role("menuitem", name="Help: Displays").click()
    sheet(tab, "Displays")


def test_the_palette_and_the_menu_lead_to_the_help(tab: StudioPage):
    page = tab.page
    page.keyboard.press("Control+k")
    page.keyboard.type("help units")
    page.get_by_role("option", name="Help: Units and angles").wait_for()
    page.keyboard.press("Enter")
    sheet(tab, "Units and angles").get_by_role("button", name="All pages").click()
    pages = sheet(tab, "Help").get_by_role("navigation")
    wait_until("all pages", lambda: pages.get_by_role("button").count() >= 24)
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Settings").click()
    page.get_by_role("menuitem", name="Help", exact=True).click()
    sheet(tab, "Help")


def test_help_on_a_window_lies_over_it_and_leaves_it_open(tab: StudioPage):
    page = tab.page
    page.get_by_role("tab", name="Properties", exact=True).focus()
    page.keyboard.press("?")
    keys = page.get_by_role("dialog", name="Keyboard shortcuts")
    keys.get_by_role("button", name="Help: Keyboard").click()
    sheet(tab, "Keyboard").get_by_role("searchbox").fill("unicorn")
    page.get_by_role("status").get_by_text("Nothing matches").wait_for()
    page.keyboard.press("Escape")
    sheet(tab, "Keyboard")
    page.keyboard.press("Escape")
    wait_until("the help to be gone", lambda: page.locator("dialog.help").count() == 0)
    wait_until("the keys", keys.is_visible)
    wait_until("the focus back", lambda: page.evaluate(_FOCUSED_TITLE) == "Help: Keyboard")
    page.keyboard.press("Escape")
    wait_until("the window to be gone", lambda: page.locator("dialog").count() == 0)


def test_the_help_speaks_the_language_of_the_page(tab: StudioPage):
    page = tab.page
    page.get_by_role("tab", name="Properties", exact=True).focus()
    page.keyboard.press("F1")
    page.locator("dialog.help article").wait_for()
    page.get_by_role("button", name="Settings").click()
    page.get_by_role("menuitemradio", name="Deutsch").click()
    page.get_by_role("heading", name="Was Sie tun können").wait_for()
    page.get_by_role("button", name="Einstellungen").click()
    page.get_by_role("menuitemradio", name="English").click()
    page.get_by_role("heading", name="What you can do").wait_for()


def test_none_of_the_help_is_loaded_before_it_is_asked_for(tab: StudioPage):
    names = """() => performance.getEntriesByType("resource")
      .filter(({ name }) => /help(\\/|-sheet|-texts|-text\\.|-search)/.test(name)).length"""
    tab.page.reload(wait_until="networkidle")
    tab.page.get_by_role("tab", name="Properties", exact=True).wait_for()
    assert tab.page.evaluate(names) == 0
    tab.page.keyboard.press("F1")
    sheet(tab, title_of(tab))
    assert tab.page.evaluate(names) > 0
