"""The source panel's larger tools, and the list of problems, as a person uses them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.browser.test_source_panel import go_to, line_of, notice, put_cursor_behind, text_of
from tests.support.studio_page import StudioPage, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Locator

    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]


@pytest.fixture(scope="module")
def opened(shared: SharedTab) -> StudioPage:
    """One tab for all tests of the file."""
    shared.anew()
    tab = shared.opened()
    wait_until("the source", lambda: "<robot" in text_of(tab))
    return tab


@pytest.fixture
def tab(opened: StudioPage) -> StudioPage:
    """The same, with nothing edited, and in front what is at first."""
    opened.undo_all()
    for name in ("Properties", "Source"):
        opened.page.get_by_role("tab", name=name, exact=True).click()
    return opened


class Counted:
    """Clicks and keys of a person, counted; typed letters of a word are one."""

    def __init__(self, tab: StudioPage) -> None:
        self.tab, self.count = tab, 0

    def click(self, what: Locator) -> None:
        self.count += 1
        what.click()

    def press(self, key: str) -> None:
        self.count += 1
        self.tab.page.keyboard.press(key)


def problems(tab: StudioPage) -> Locator:
    return tab.page.locator("section[aria-label='Problems']")


def undo_button(tab: StudioPage) -> Locator:
    return tab.page.locator(".icon-button[aria-label='Undo']")


def test_a_property_is_renamed_over_files_and_undone_as_one_step(tab: StudioPage):
    before = tab.settle()
    go_to(tab, "wheel_width")
    put_cursor_behind(tab, '"wheel_wi')
    tab.page.keyboard.press("F2")
    card = tab.page.get_by_role("dialog", name="Rename property wheel_width")
    wait_until("the card", card.is_visible)
    tab.page.keyboard.type("wheel_radius")
    wait_until("the refusal", lambda: "is a name already" in card.inner_text())
    assert card.get_by_role("button", name="Rename", exact=True).is_disabled()
    tab.page.keyboard.press("Control+a")
    tab.page.keyboard.type("tyre_width")
    wait_until("the places", lambda: "10 places in 3 files" in card.inner_text())
    tab.page.keyboard.press("Enter")
    wait_until("the text", lambda: 'name="tyre_width"' in text_of(tab))
    wait_until("the card to be gone", lambda: tab.page.get_by_text("3 files").count() == 0)
    tab.seek("tyre_width")
    tab.show_again(before)
    undo_button(tab).click()
    wait_until("the old name", lambda: 'name="wheel_width"' in text_of(tab))
    wait_until("nothing more to undo", lambda: not undo_button(tab).is_enabled())
    assert tab.errors == []


def test_words_are_found_in_all_files_and_replaced(tab: StudioPage):
    tab.page.locator(".cm-content").click()
    tab.page.keyboard.press("Control+Shift+F")
    search = tab.page.get_by_role("form", name="Find in all files")
    search.get_by_role("searchbox").fill("hub_ratio")
    wait_until("what is found", lambda: "places in 2 files" in search.inner_text())
    search.get_by_role("button", name="wheel_radius").last.click()
    wait_until("its file", tab.page.get_by_role("tab", name="wheel.xacro").is_visible)
    wait_until("its line", lambda: "hub_ratio" in line_of(tab))
    search.get_by_role("textbox", name="Replace with").fill("rim_ratio")
    search.get_by_role("button", name="Replace all").click()
    wait_until("the text", lambda: "rim_ratio" in text_of(tab))
    wait_until("the count", lambda: "Nothing found" in search.inner_text())
    assert tab.errors == []


def test_a_typo_is_shown_at_its_line_with_the_model_still_there_and_mended_in_three(
    tab: StudioPage,
):
    before = tab.settle()
    go_to(tab, "wheel_width")
    put_cursor_behind(tab, '"${wheel_radi')
    tab.page.keyboard.press("Backspace")
    wait_until("the notice over the 3D view", notice(tab).is_visible)
    marker = tab.page.locator(".cm-lint-marker-error")
    wait_until("the dot at its line", lambda: marker.count() > 0)
    assert tab.has_drawn_robot()
    person = Counted(tab)
    person.click(tab.page.get_by_role("tab", name="Problems"))
    row = problems(tab).locator(".problem.error").first
    wait_until("the row", row.is_visible)
    assert "wheel_radus" in row.inner_text()
    person.click(row.locator(".problem-fix"))
    wait_until("the notice to go", lambda: not notice(tab).is_visible())
    assert person.count <= 3
    tab.show_again(before)
    assert tab.errors == []


def test_a_changed_line_tells_what_it_was_and_is_put_back(tab: StudioPage):
    go_to(tab, "wheel_radius")
    put_cursor_behind(tab, '"0.105')
    tab.page.keyboard.type("5")
    mark = tab.page.locator(".source-changes .cm-gutterElement:has(.source-change)")
    wait_until("the mark", lambda: mark.count() == 1)
    mark.click()
    card = tab.page.get_by_role("dialog", name="When it was saved")
    wait_until("what it was", lambda: 'value="0.105"' in card.inner_text())
    card.get_by_role("button", name="Put back").click()
    wait_until("the mark to go", lambda: mark.count() == 0)
    assert 'value="0.105"' in text_of(tab)
    dot = tab.page.get_by_role("tab", name="rover.urdf.xacro").get_by_label("unsaved")
    wait_until("nothing unsaved", lambda: dot.count() == 0)


def test_the_urdf_shows_what_an_edit_changes_in_it(tab: StudioPage):
    tab.drag_slider("wheel_radius", 0.8)
    tab.page.get_by_role("tab", name="URDF", exact=True).click()
    urdf = tab.page.locator("section[aria-label='URDF']")
    wait_until("the whole", lambda: urdf.locator(".cm-line").count() > 5)
    urdf.get_by_role("button", name="Changes", exact=True).click()
    wait_until("new lines", lambda: urdf.locator(".urdf-new").count() > 0)
    assert urdf.locator(".urdf-old").count() > 0
    undo_button(tab).click()
    wait_until("no change", lambda: "Nothing is unsaved" in urdf.inner_text())
    assert tab.errors == []
