"""The source panel as a person uses it: type, break, rename, find and put back, beside sliders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until
from tests.support.wire import free_port

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio
    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]


@pytest.fixture(scope="module")
def studio(shared: SharedTab) -> RunningStudio:
    return shared.anew()


@pytest.fixture(scope="module")
def opened(shared: SharedTab, studio: RunningStudio) -> StudioPage:
    """One tab for all tests of the file."""
    del studio  # as at first, before the tab opens it
    tab = shared.opened()
    wait_until("the source", lambda: "<robot" in text_of(tab))
    return tab


@pytest.fixture
def tab(opened: StudioPage) -> StudioPage:
    """The same, with nothing edited, and in front what is at first."""
    opened.undo_all()
    for name in ("Properties", "Source"):
        opened.page.get_by_role("tab", name=name).first.click()
    return opened


def text_of(tab: StudioPage) -> str:
    """What the editor shows of the text in front."""
    content = tab.page.locator(".cm-content")
    return content.inner_text() if content.count() else ""


def line_of(tab: StudioPage) -> str:
    """The line with the cursor."""
    return tab.page.locator(".cm-activeLine").inner_text()


def go_to(tab: StudioPage, property_name: str) -> None:
    """Go to a property's line by the menu of its row."""
    tab.seek(property_name)
    tab.row(property_name).get_by_role("button", name="More").click()
    tab.page.get_by_role("menuitem", name="Show in the source").click()
    wait_until("its line", lambda: f'name="{property_name}"' in line_of(tab))


def put_cursor_behind(tab: StudioPage, words: str) -> None:
    """Walk to the end of some words in the line of the cursor."""
    tab.page.keyboard.press("Home")
    line = line_of(tab).lstrip()
    for _ in range(line.index(words) + len(words)):
        tab.page.keyboard.press("ArrowRight")


def notice(tab: StudioPage) -> Locator:
    return tab.page.get_by_text("Showing the last good model")


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


def test_a_typed_number_moves_the_pixels_and_its_slider_and_is_undone_as_one_step(
    tab: StudioPage, data: Path
):
    go_to(tab, "wheel_radius")
    before = tab.plain_picture()
    put_cursor_behind(tab, '"0.1')
    tab.page.keyboard.press("Shift+ArrowRight")
    tab.page.keyboard.press("Shift+ArrowRight")
    tab.page.keyboard.type("55", delay=40)
    wait_until("the slider to follow", lambda: tab.box("wheel_radius").input_value() == "0.155")
    tab.show_other_than(before)
    dot = tab.page.get_by_role("tab", name="rover.urdf.xacro").get_by_label("unsaved")
    wait_until("the tab to be unsaved", dot.is_visible)

    tab.page.locator(".cm-content").press("Control+z")
    wait_until("the undo", lambda: tab.box("wheel_radius").input_value() == "0.105")
    wait_until("the text", lambda: 'value="0.105"' in line_of(tab))
    tab.show_again(before)
    assert not tab.page.get_by_role("button", name="Undo", exact=True).is_enabled()

    put_cursor_behind(tab, '"0.10')
    tab.page.keyboard.type("2")
    tab.page.keyboard.press("Control+s")
    tab.agree_to_save()
    saved = data / "models" / "rover_description/urdf/rover.urdf.xacro"
    wait_until("the file", lambda: b'"wheel_radius" value="0.1025"' in saved.read_bytes())
    assert tab.errors == []

    tab.undo_all()  # and what was written, for the tests that follow
    tab.page.keyboard.press("Control+s")
    tab.agree_to_save()
    wait_until("the file as it was", lambda: b'"wheel_radius" value="0.105"' in saved.read_bytes())


def test_broken_text_is_underlined_and_the_last_good_model_stays(tab: StudioPage):
    go_to(tab, "wheel_radius")
    before = tab.plain_picture()
    put_cursor_behind(tab, "<xacro:property")
    tab.page.keyboard.press("Backspace")
    wait_until("the notice over the 3D view", notice(tab).is_visible)
    underlined = tab.page.locator(".cm-lintRange-error")
    wait_until("the underline", lambda: underlined.count() > 0)
    assert "xacro:prop" in underlined.first.inner_text()
    assert tab.has_drawn_robot()
    tab.page.keyboard.type("y")
    wait_until("the notice to go", lambda: not notice(tab).is_visible())
    wait_until("the underline to go", lambda: underlined.count() == 0)
    tab.show_again(before)
    assert tab.errors == []


def test_a_slider_writes_into_the_text_and_leaves_cursor_and_scroll(tab: StudioPage):
    go_to(tab, "wheel_radius")
    place = tab.page.locator(".source-place .numbers")
    put_cursor_behind(tab, "<xacro:property")
    scroller = tab.page.locator(".cm-scroller")
    before = (place.inner_text(), scroller.evaluate("one => one.scrollTop"))
    value = tab.drag_slider("wheel_radius", 0.8)
    lit = tab.page.locator(".source-lit", has_text='name="wheel_radius"')
    wait_until("the line of the row under the pointer to light up", lambda: lit.count() == 1)
    assert value != "0.105"
    wait_until("the text to follow", lambda: f'value="{value}"' in line_of(tab))
    assert (place.inner_text(), scroller.evaluate("one => one.scrollTop")) == before


def test_what_one_types_another_sees_and_a_viewer_cannot_change(
    tab: StudioPage, studio: RunningStudio, browser: Browser
):
    with studio_page(browser, studio, view=False, viewer=True) as viewer:
        wait_until("the viewer's text", lambda: "<robot" in text_of(viewer))
        go_to(viewer, "wheel_radius")
        go_to(tab, "wheel_radius")
        put_cursor_behind(tab, '"0.105')
        tab.page.keyboard.type("7")
        wait_until("it to arrive", lambda: 'value="0.1057"' in line_of(viewer))
        seen = text_of(viewer)
        viewer.page.keyboard.type("x")
        viewer.page.keyboard.press("Backspace")
        assert text_of(viewer) == seen
        assert viewer.page.get_by_text("the text is read-only").is_visible()
        assert viewer.errors == []


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
    row = problems(tab).locator(".problem.error").filter(has_text="wheel_radus").first
    wait_until("the row", row.is_visible)
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


def test_after_a_restart_of_the_studio_the_open_text_is_typed_into_as_before(
    browser: Browser, tmp_path: Path
):
    port = free_port()  # one that nobody is lent while no studio holds it
    first_one = running_studio(["demo"], tmp_path / "data", port=port)
    with first_one as first, studio_page(browser, first, view=False) as tab:
        go_to(tab, "wheel_radius")
        first.stop()
        wait_until("the page to say so", lambda: "Studio: offline" in tab.page.inner_text("body"))
        with running_studio(["demo"], tmp_path / "data", port=port) as second:
            wait_until(
                "it to be back", lambda: "Studio: offline" not in tab.page.inner_text("body")
            )
            second.hear_sites("rover")
            tab.page.locator(".cm-content").focus()
            put_cursor_behind(tab, '"0.10')
            tab.page.keyboard.type("7")
            wait_until("the row", lambda: tab.box("wheel_radius").input_value() == "0.1075")
