"""Words of the source explain themselves, lead to their definition, and are completed."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest

from tests.browser.test_source_panel import line_of, text_of
from tests.support.studio_page import StudioPage, studio_page, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from tests.support.server import RunningStudio
    from tests.support.shared_tab import SharedTab

FRONT = "${front * wheel_base / 2}"

_REST_S = 4.0
_BOX = """(text) => {
  const all = [...document.querySelectorAll(".cm-line .source-expression")];
  const found = all.find((one) => one.textContent === text);
  found?.scrollIntoView({ block: "nearest" });
  const box = found?.getBoundingClientRect();
  return box ? [box.x, box.y, box.width, box.height] : null;
}"""

_FRAMES = """async () => {
  for (let n = 0; n < 8; n += 1) await new Promise((done) => requestAnimationFrame(done));
}"""
_HAS_FOCUS = "() => document.activeElement?.classList.contains('cm-content')"

pytestmark = [
    pytest.mark.browser,
    pytest.mark.network,
    pytest.mark.timeout(240),
]


@pytest.fixture(scope="module")
def studio(shared: SharedTab) -> RunningStudio:
    return shared.anew()


@pytest.fixture(scope="module")
def opened(shared: SharedTab, studio: RunningStudio) -> StudioPage:
    """One tab for all tests of the file."""
    del studio  # as at first, before the tab opens it
    tab = shared.opened(view=False)
    wait_until("the source", lambda: "<robot" in text_of(tab))
    return tab


@pytest.fixture
def tab(opened: StudioPage) -> StudioPage:
    """The same, with nothing edited, at the file of the wheel."""
    opened.undo_all()
    open_file(opened, "wheel.xacro")
    return opened


def open_file(tab: StudioPage, name: str) -> None:
    """Open a file from the include tree."""
    tab.page.get_by_role("tab", name="Files & macros").first.click()
    tab.page.get_by_role("treeitem", name=name).click()
    wait_until(name, lambda: box_of(tab, FRONT) is not None)


def box_of(tab: StudioPage, text: str) -> list[float] | None:
    """Where a `${...}` of the text in front is on the screen: x, y, width, height."""
    return tab.page.evaluate(_BOX, text)


def point_at(tab: StudioPage, text: str, word: str, *, click: bool = False) -> None:
    """Put the mouse, or the cursor, on a word of an expression."""
    wait_until(
        text, lambda: box_of(tab, text) is not None and box_of(tab, text) == box_of(tab, text)
    )
    box = box_of(tab, text)
    assert box is not None
    x = box[0] + box[2] * (text.index(word) + len(word) / 2) / len(text)
    y = box[1] + box[3] / 2
    tab.page.mouse.move(x - 2, y)
    tab.page.mouse.move(x, y)
    if click:
        tab.page.mouse.click(x, y)


def arrive(tab: StudioPage, words: str) -> None:
    """Wait for a line with the cursor in it, and the focus."""
    wait_until(words, lambda: words in line_of(tab))
    tab.page.evaluate(_FRAMES)  # the cursor is put there in a frame after the text is
    wait_until("the focus", lambda: bool(tab.page.evaluate(_HAS_FOCUS)))


def read_by_pointing(tab: StudioPage, text: str, word: str, expected: str) -> None:
    """Rest with the mouse on a word until its card says something.

    The editor may draw its line anew under the mouse, and then waits for the next move.
    """
    moved_s = 0.0

    def is_said() -> bool:
        nonlocal moved_s
        if expected in card(tab):
            return True
        if time.monotonic() - moved_s > _REST_S:
            point_at(tab, text, word)
            moved_s = time.monotonic()
        return False

    wait_until(f"{expected} to be said of {word}", is_said)


def card(tab: StudioPage) -> str:
    """What is said of the word in hand."""
    shown = tab.page.locator(".meaning")
    return shown.first.inner_text() if shown.count() else ""


def test_a_word_shows_its_value_and_leads_to_its_definition_in_another_file(tab: StudioPage):
    read_by_pointing(tab, FRONT, "wheel_base", "0.38")
    assert "property" in card(tab)
    assert "0.19" in card(tab), "what the expression came to is not said"
    point_at(tab, FRONT, "front", click=True)
    tab.page.mouse.move(5, 5)
    wait_until("the card to go", lambda: card(tab) == "")
    tab.page.keyboard.press("Alt+F12")
    wait_until("the values of all calls", lambda: "-1" in card(tab))
    tab.page.keyboard.press("Escape")
    wait_until("the card to go", lambda: card(tab) == "")
    point_at(tab, FRONT, "wheel_base", click=True)
    tab.page.keyboard.press("F12")
    arrive(tab, 'name="wheel_base"')
    tab.page.keyboard.press("Shift+F12")
    wait_until("who reads it", lambda: "wheel.xacro" in card(tab))
    tab.page.locator(".place-list").get_by_role("button", name="wheel.xacro").first.click()
    arrive(tab, "* wheel_base")
    tab.page.keyboard.press("Alt+ArrowLeft")
    arrive(tab, 'name="wheel_base"')
    assert tab.errors == []


@pytest.mark.sweep
def test_letters_stand_as_they_were_typed_while_marks_come_and_go(tab: StudioPage):
    point_at(tab, FRONT, "front", click=True)
    keyboard = tab.page.keyboard
    keyboard.press("End")
    for name in ("first", "second"):
        keyboard.press("Enter")
        keyboard.press("Escape")  # no list of offers that Enter would choose from
        keyboard.type(f"<xacro:property name='{name}' value='${{2 * 3}}'/>", delay=70)
        wait_until(
            "the line", lambda name=name: f"name='{name}' value='${{2 * 3}}'/>" in line_of(tab)
        )
        assert line_of(tab).strip() == f"<xacro:property name='{name}' value='${{2 * 3}}'/>"
    assert tab.errors == []


def test_a_call_is_completed_and_another_one_inserted_from_the_list_of_macros(tab: StudioPage):
    point_at(tab, FRONT, "front", click=True)
    keyboard = tab.page.keyboard
    keyboard.press("End")
    keyboard.press("Enter")
    keyboard.type("<xacro:lam", delay=40)
    offer = tab.page.get_by_role("option", name="xacro:lamp")
    wait_until("the offer", offer.is_visible)
    offer.click()
    wait_until("the call", lambda: '<xacro:lamp side="" front="" glass=""/>' in line_of(tab))
    keyboard.type("1")
    keyboard.press("Tab")
    keyboard.type("${whe", delay=40)
    radius = tab.page.get_by_role("option", name="wheel_radius")
    wait_until("names with values", lambda: radius.count() == 1 and "0.105" in radius.inner_text())
    radius.click()
    wait_until("the name", lambda: 'side="1" front="${wheel_radius}"' in line_of(tab))
    tab.page.get_by_role("searchbox", name="Filter files and macros").fill("spoke")
    tab.page.get_by_role("button", name="spoke", exact=False).first.click()
    tab.page.get_by_role("button", name="Insert call").click()
    wait_until("the second call", lambda: "<xacro:spoke" in line_of(tab))
    assert tab.errors == []


def test_a_viewer_reads_what_words_mean_and_writes_nothing(browser: Browser, studio: RunningStudio):
    with studio_page(browser, studio, view=False, viewer=True) as viewer:
        wait_until("the viewer's text", lambda: "<robot" in text_of(viewer))
        open_file(viewer, "wheel.xacro")
        read_by_pointing(viewer, FRONT, "wheel_base", "0.38")
        viewer.page.get_by_role("button", name="spoke", exact=False).first.click()
        viewer.page.get_by_role("button", name="Go to definition").wait_for()
        assert viewer.page.get_by_role("button", name="Insert call").count() == 0
        viewer.page.get_by_role("treeitem", name="rover.urdf.xacro").focus()
        viewer.page.keyboard.press("ArrowDown")
        viewer.page.keyboard.press("Enter")
        wait_until("the file that keys chose", lambda: "<material" in text_of(viewer))
        assert viewer.errors == []
