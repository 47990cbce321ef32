"""The frame of the page as a person uses it: by Tab, from tab to tab, in windows of any size."""

from __future__ import annotations

import base64
import io
import re
from typing import TYPE_CHECKING, Any

import pytest
from PIL import Image, ImageStat

from tests.support.studio_page import VIEWPORT, StudioPage, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Browser, FloatRect, Locator

    from tests.support.server import RunningStudio


pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

_TABS_ENOUGH = 80
"""More controls than stand before the editor."""
_CUT_TABS = """() => [...document.querySelectorAll(".dv-tabs-container")].flatMap((tabs) => {
  const room = tabs.getBoundingClientRect();
  return [...tabs.children].filter((tab) => {
    const { left, right } = tab.getBoundingClientRect();
    const label = tab.querySelector(".tab-label").getBoundingClientRect();
    const isCut = left < room.left - 1 || right > room.right + 1;
    return getComputedStyle(tab).opacity === "1" && (isCut || label.width < 10);
  }).map((tab) => tab.textContent);
})"""
"""Tabs that are seen, and of which a part or the name is not."""
_SAY_SLOW = """async () => {
  const app = new URL("./", document.querySelector('script[src*="app/main.js"]').src);
  const state = await import(new URL("graphics.js", app));
  state.graphicsSaid.value = false;
  state.graphicsChoice.value = "automatic";
  state.graphics.value = { ...state.graphics.value, light: true };
}"""
_DARK_BY_CHOICE = """try { localStorage.setItem("studio.theme", '"dark"'); } catch {}"""
_DARK = 100
"""Brightness that the 3D view stays below, with a robot in it."""


@pytest.fixture
def tab(tab: StudioPage) -> StudioPage:
    wait_until("the source", lambda: tab.page.locator(".cm-line").count() > 0)
    return tab


def panel_tab(tab: StudioPage, name: str) -> Locator:
    return tab.page.get_by_role("tab", name=re.compile(f"^{name}(,|$)"))


def focus_is_in_editor(tab: StudioPage) -> bool:
    return bool(tab.page.evaluate("() => document.activeElement.matches('.cm-content')"))


def walk_into_editor(tab: StudioPage) -> None:
    """Press Tab from the top of the page until the source has the focus."""
    tab.page.get_by_role("link", name="Studio: start page").focus()
    for _ in range(_TABS_ENOUGH):
        tab.page.keyboard.press("Tab")
        if focus_is_in_editor(tab):
            return
    pytest.fail("Tab never came to the source.")


def first_line(tab: StudioPage) -> str:
    return tab.page.locator(".cm-line").first.inner_text()


@pytest.mark.without_view
def test_tab_walks_through_the_source_until_one_has_begun_to_edit(tab: StudioPage):
    wait_until("the text", lambda: first_line(tab) != "")
    before = first_line(tab)
    walk_into_editor(tab)
    tab.page.keyboard.press("Tab")
    assert not focus_is_in_editor(tab)
    assert first_line(tab) == before
    tab.page.keyboard.press("Shift+Tab")
    assert focus_is_in_editor(tab)
    tab.page.keyboard.press("End")
    tab.page.keyboard.type(" ")
    tab.page.keyboard.press("Tab")
    assert focus_is_in_editor(tab)
    assert first_line(tab) != before
    tab.page.keyboard.press("Escape")
    tab.page.keyboard.press("Tab")
    assert not focus_is_in_editor(tab)


def scroll_down(tab: StudioPage, scroller: Locator) -> float:
    """Turn the wheel over it; where it came to."""
    scroller.hover()
    tab.page.mouse.wheel(0, 700)
    wait_until("it to scroll", lambda: scroller.evaluate("one => one.scrollTop") > 300)
    return float(scroller.evaluate("one => one.scrollTop"))


@pytest.mark.parametrize(
    ("panel", "other", "scroller"),
    [
        ("Source", "Problems", ".cm-scroller"),
        ("Properties", "Joints", '[aria-label="Properties"] > .scroll'),
    ],
)
@pytest.mark.without_view
def test_a_panel_comes_back_where_it_was_scrolled_to(
    tab: StudioPage, panel: str, other: str, scroller: str
):
    place = tab.page.locator(scroller).first
    top = scroll_down(tab, place)
    panel_tab(tab, other).click()
    wait_until("the other panel", lambda: not place.is_visible())
    panel_tab(tab, panel).click()
    wait_until("the panel again", place.is_visible)
    where = pytest.approx(top, abs=1)
    wait_until("where it was", lambda: place.evaluate("one => one.scrollTop") == where)


@pytest.mark.without_view
def test_no_tab_is_cut_in_a_window_of_any_size(tab: StudioPage):
    tab.page.get_by_role("button", name="Settings").click()
    tab.page.get_by_role("menuitemradio", name="Deutsch").click()
    panel_tab(tab, "Herkunft").wait_for()
    for width in (1600, 1280, 1024, 760):
        tab.page.set_viewport_size({"width": width, "height": 720})
        wait_until(f"whole tabs at {width} px", lambda: tab.page.evaluate(_CUT_TABS) == [])


@pytest.mark.without_view
def test_tabs_that_do_not_fit_are_in_a_menu_at_their_end(tab: StudioPage):
    tab.page.get_by_role("button", name="Live", exact=True).click()
    more = tab.page.get_by_role("button", name="More tabs").locator("visible=true").first
    more.click()
    tab.page.get_by_role("menuitem", name="Lessons").click()
    wait_until("it to be in front", lambda: in_front(tab, "Lessons"))
    tab.page.get_by_role("button", name="Model", exact=True).click()
    wait_until("the layout for a model", panel_tab(tab, "Properties").is_visible)


def in_front(tab: StudioPage, name: str) -> bool:
    return panel_tab(tab, name).get_attribute("aria-selected") == "true"


@pytest.mark.without_view
def test_the_menu_of_panels_begins_with_the_layouts_and_groups_the_panels(tab: StudioPage):
    tab.page.get_by_role("button", name="Panels and layouts").click()
    lines = tab.page.get_by_role("menu").inner_text().split("\n")
    assert lines[:3] == ["Layouts", "Model", "Live"]
    headings = ["Robot", "Files and problems", "ROS 2: look", "ROS 2: act", "Learn"]
    assert [one for one in lines if one in headings] == headings


def test_no_notice_covers_an_error_of_the_3d_view(tab: StudioPage):
    tab.page.evaluate(_SAY_SLOW)
    slow = tab.page.get_by_text("This computer draws slowly")
    slow.wait_for()
    tab.seek("wheel_radius")
    tab.box("wheel_radius").fill("nonsense + 1")
    tab.box("wheel_radius").press("Enter")
    error = tab.page.locator(".last-good")
    error.wait_for()
    assert slow.is_visible()
    above, below = error.bounding_box(), slow.bounding_box()
    assert above is not None
    assert below is not None
    assert above["y"] + above["height"] <= below["y"]
    error.get_by_role("button", name="Undo edit").click()
    error.wait_for(state="detached")


def test_the_3d_view_is_never_white_while_it_opens_in_the_dark_theme(
    browser: Browser, studio: RunningStudio
):
    context = browser.new_context(viewport=VIEWPORT, color_scheme="light")
    context.add_init_script(_DARK_BY_CHOICE)
    tab = StudioPage(context.new_page())
    recording: Any = context.new_cdp_session(tab.page)
    pictures: list[str] = []

    def keep(event: dict[str, Any]) -> None:
        pictures.append(event["data"])
        recording.send("Page.screencastFrameAck", {"sessionId": event["sessionId"]})

    recording.on("Page.screencastFrame", keep)
    recording.send("Page.startScreencast", {"format": "png"})
    try:
        tab.open(studio.url)
        place = tab.page.locator("iframe").bounding_box()
        assert place is not None
        seen = [brightness(one, place) for one in pictures]
        # The first ones are of the empty tab, before the page came.
        since = next(n for n, one in enumerate(seen) if one < _DARK)
        assert max(seen[since:]) < _DARK, seen
    finally:
        context.close()


def brightness(picture: str, place: FloatRect) -> float:
    """Of the middle of a place in a recorded picture, from 0 to 255."""
    left, top = int(place["x"] + place["width"] / 4), int(place["y"] + place["height"] / 4)
    right, bottom = left + int(place["width"] / 2), top + int(place["height"] / 2)
    with Image.open(io.BytesIO(base64.b64decode(picture))) as image:
        return ImageStat.Stat(image.convert("L").crop((left, top, right, bottom))).mean[0]


@pytest.mark.without_view
def test_every_panel_has_a_way_on_a_phone(tab: StudioPage):
    tab.page.set_viewport_size({"width": 390, "height": 844})
    bar = tab.page.get_by_role("navigation", name="Panels")
    bar.get_by_role("button", name="More").click()
    tab.page.get_by_role("menuitem", name="Source").click()
    wait_until("the source", tab.page.locator(".cm-content").is_visible)
    wait_until("its name in the bar", lambda: "Source" in bar.inner_text())


@pytest.mark.without_view
def test_a_link_that_is_selected_in_the_tree_stays_in_view_above_its_details(tab: StudioPage):
    row = tab.page.get_by_role("treeitem", name="upper_arm", exact=True)
    row.click()
    details = tab.page.get_by_role("complementary", name="upper_arm")
    wait_until("its details", details.is_visible)
    wait_until("both to be in view", lambda: bottom_of(row) <= top_of(details))


def bottom_of(one: Locator) -> float:
    return float(one.evaluate("one => one.getBoundingClientRect().bottom"))


def top_of(one: Locator) -> float:
    return float(one.evaluate("one => one.getBoundingClientRect().top"))


@pytest.mark.without_view
def test_who_logs_everybody_out_is_told_how_to_come_back(tab: StudioPage):
    tab.page.keyboard.press("Control+k")
    tab.page.keyboard.type("log everybody out")
    tab.page.get_by_role("option", name="Log everybody out").click()
    tab.page.get_by_role("button", name="Log out", exact=True).click()
    tab.page.get_by_text("Open the address that the studio prints").wait_for()
