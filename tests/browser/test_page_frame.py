"""The frame of the page as a person uses it: by Tab, from tab to tab, in windows of any size."""

from __future__ import annotations

import base64
import io
import re
from typing import TYPE_CHECKING, Any, Final

import pytest
from PIL import Image, ImageStat

from tests.support.studio_page import VIEWPORT, StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, FloatRect, Locator, ViewportSize

    from tests.support.shared_tab import SharedDemo, SharedTab

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
_FIRST_LAYOUT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../lib/commands.js", script))).commandById("layout.0").run();
}"""
_SHOW_VIEWS = _FIRST_LAYOUT.replace("layout.0", "panel.views")
_OPEN_VIEWS = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { layoutControl } = await import(new URL("../model/view.js", script));
  layoutControl.value.open(["views"]);
}"""
"""As a config does that has this panel."""
_SOME_PICTURES = """async () => {
  for (let n = 0; n < 12; n += 1) await new Promise(requestAnimationFrame);
}"""
"""Of a page that has everything in its place again."""
_LEAVING_IS_STOPPED = """() => {
  const leaving = new Event("beforeunload", { cancelable: true });
  window.dispatchEvent(leaving);
  return leaving.defaultPrevented;
}"""
_DARK_BY_CHOICE = """try { localStorage.setItem("studio.theme", '"dark"'); } catch {}"""
_LOGGED_OUT = "Open the address that the studio prints"
_DARK = 100
"""Brightness that the 3D view stays below, with a robot in it."""
_WINDOW: Final[ViewportSize] = {"width": 1000, "height": 600}
_RECORDED_WIDTH: Final = 250


@pytest.fixture(scope="module")
def opened(shared: SharedTab) -> StudioPage:
    """One tab, with an empty 3D view."""
    shared.anew()
    return shared.opened(view=False)


@pytest.fixture
def tab(shared: SharedTab, opened: StudioPage) -> Iterator[StudioPage]:
    """That tab, with its panels where they were at first."""
    if opened.page.get_by_text(_LOGGED_OUT).count():
        shared.opened(view=False)
        opened.errors.clear()
    opened.page.set_viewport_size(VIEWPORT)
    opened.page.evaluate(_FIRST_LAYOUT)
    opened.page.locator(".cm-line").first.wait_for()
    yield opened
    assert opened.errors == []


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


def asks_on_leaving(tab: StudioPage) -> bool:
    """Whether the browser would ask before the page is closed."""
    return bool(tab.page.evaluate(_LEAVING_IS_STOPPED))


def test_tab_walks_through_the_source_until_one_has_begun_to_edit(tab: StudioPage):
    wait_until("the text", lambda: first_line(tab) != "")
    before = first_line(tab)
    walk_into_editor(tab)
    tab.page.keyboard.press("Tab")
    assert not focus_is_in_editor(tab)
    assert first_line(tab) == before
    assert not asks_on_leaving(tab)
    tab.page.keyboard.press("Shift+Tab")
    assert focus_is_in_editor(tab)
    tab.page.keyboard.press("End")
    tab.page.keyboard.type(" ")
    tab.page.keyboard.press("Tab")
    assert focus_is_in_editor(tab)
    assert first_line(tab) != before
    wait_until("leaving asks", lambda: asks_on_leaving(tab))
    tab.page.keyboard.press("Escape")
    tab.page.keyboard.press("Tab")
    assert not focus_is_in_editor(tab)
    tab.page.get_by_role("button", name="Undo", exact=True).click()
    wait_until("the text of before", lambda: first_line(tab) == before)
    wait_until("leaving asks nothing", lambda: not asks_on_leaving(tab))


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


def test_no_tab_is_cut_in_a_window_of_any_size(tab: StudioPage):
    tab.page.get_by_role("button", name="Settings").click()
    tab.page.get_by_role("menuitemradio", name="Deutsch").click()
    panel_tab(tab, "Herkunft").wait_for()
    for width in (1600, 1280, 1024, 760):
        tab.page.set_viewport_size({"width": width, "height": 720})
        wait_until(f"whole tabs at {width} px", lambda: tab.page.evaluate(_CUT_TABS) == [])
    tab.page.get_by_role("button", name="Einstellungen").click()
    tab.page.get_by_role("menuitemradio", name="English").click()
    tab.page.locator("html[lang=en]").wait_for()


def test_the_tab_of_a_panel_that_is_opened_is_whole(tab: StudioPage):
    tab.page.evaluate(_SHOW_VIEWS)
    wait_until("it to be in front", lambda: in_front(tab, "Views"))
    tab.page.evaluate(_SOME_PICTURES)
    wait_until("a whole tab", lambda: tab.page.evaluate(_CUT_TABS) == [])


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


def test_the_menu_of_panels_begins_with_the_layouts_and_groups_the_panels(tab: StudioPage):
    tab.page.get_by_role("button", name="Panels and layouts").click()
    lines = tab.page.get_by_role("menu").inner_text().split("\n")
    assert lines[:3] == ["Layouts", "Model", "Live"]
    headings = ["Robot", "Files and problems", "ROS 2: look", "ROS 2: act", "Learn"]
    assert [one for one in lines if one in headings] == headings
    tab.page.keyboard.press("Escape")


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
    tab.page.get_by_role("status").filter(has=slow).get_by_role("button", name="Dismiss").click()
    slow.wait_for(state="detached")


@pytest.mark.sweep
def test_the_3d_view_is_never_white_while_it_opens_in_the_dark_theme(
    browser: Browser, opened: StudioPage, demo: SharedDemo
):
    del opened  # which has the demo open
    context = studio_context(browser)
    context.add_init_script(_DARK_BY_CHOICE)
    tab = StudioPage(context.new_page())
    tab.page.set_viewport_size(_WINDOW)
    recording: Any = context.new_cdp_session(tab.page)
    pictures: list[str] = []

    def keep(event: dict[str, Any]) -> None:
        pictures.append(event["data"])
        recording.send("Page.screencastFrameAck", {"sessionId": event["sessionId"]})

    recording.on("Page.screencastFrame", keep)
    recording.send("Page.startScreencast", {"format": "jpeg", "maxWidth": _RECORDED_WIDTH})
    try:
        tab.open(demo.studio.url)
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
    scale = _RECORDED_WIDTH / _WINDOW["width"]
    left, top = place["x"] + place["width"] / 4, place["y"] + place["height"] / 4
    right, bottom = left + place["width"] / 2, top + place["height"] / 2
    middle = (int(left * scale), int(top * scale), int(right * scale), int(bottom * scale))
    with Image.open(io.BytesIO(base64.b64decode(picture))) as image:
        assert image.width == _RECORDED_WIDTH
        return ImageStat.Stat(image.convert("L").crop(middle)).mean[0]


def test_every_panel_has_a_way_on_a_phone(tab: StudioPage):
    tab.page.set_viewport_size({"width": 390, "height": 844})
    bar = tab.page.get_by_role("navigation", name="Panels")
    bar.get_by_role("button", name="More").click()
    tab.page.get_by_role("menuitem", name="Source").click()
    wait_until("the source", tab.page.locator(".cm-content").is_visible)
    wait_until("its name in the bar", lambda: "Source" in bar.inner_text())


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


def test_who_logs_everybody_out_is_told_how_to_come_back(opened: StudioPage):
    tab = opened  # which complains that it is refused
    tab.page.keyboard.press("Control+k")
    tab.page.keyboard.type("log everybody out")
    tab.page.get_by_role("option", name="Log everybody out").click()
    tab.page.get_by_role("button", name="Log out", exact=True).click()
    tab.page.get_by_text(_LOGGED_OUT).wait_for()


def floating(tab: StudioPage) -> FloatRect:
    """Where the one window over the page is."""
    box = tab.page.locator(".dv-resize-container").bounding_box()
    assert box is not None
    return box


def shift(before: FloatRect, after: FloatRect) -> tuple[int, int, int, int]:
    """By how many pixels it moved to the right and down, and grew."""
    right, down = round(after["x"] - before["x"]), round(after["y"] - before["y"])
    wider, higher = after["width"] - before["width"], after["height"] - before["height"]
    return right, down, round(wider), round(higher)


def drag_by_finger(tab: StudioPage, by_px: int) -> None:
    """The window over the page, to the left."""
    with tab.finger() as touch:
        before, bar = floating(tab), tab.page.locator(".dv-floating-titlebar").bounding_box()
        assert bar is not None
        x, y = bar["x"] + 40, bar["y"] + bar["height"] / 2
        touch("touchStart", (x, y))
        for share in (0.3, 0.6, 1):
            touch("touchMove", (x + share * by_px, y))
        touch("touchEnd")
        # It follows from the first move on.
        wait_until("it went along", lambda: by_px <= shift(before, floating(tab))[0] <= by_px / 2)


def test_a_panel_floats_is_moved_and_sized_by_keys_and_mouse_kept_and_docked(tab: StudioPage):
    page = tab.page
    panel_tab(tab, "Masses").click()
    page.get_by_role("button", name="Float Masses").click()
    first = floating(tab)
    for key in ("Alt+ArrowRight", "Alt+ArrowDown", "Alt+Shift+ArrowDown"):
        page.keyboard.press(key)
    wait_until("it moved", lambda: shift(first, floating(tab)) == (24, 24, 0, 24))
    bar = page.locator(".dv-floating-titlebar").bounding_box()
    assert bar is not None
    page.mouse.move(bar["x"] + 40, bar["y"] + 6)
    page.mouse.down()
    page.mouse.move(bar["x"] - 60, bar["y"] + 6, steps=4)
    page.mouse.up()
    wait_until("it was dragged", lambda: shift(first, floating(tab))[0] < -40)
    dragged = floating(tab)
    page.reload()
    page.locator(".dv-resize-container").wait_for()
    wait_until("it is kept", lambda: shift(dragged, floating(tab)) == (0, 0, 0, 0))
    drag_by_finger(tab, by_px=-50)
    page.get_by_role("button", name="Dock Masses").click()
    wait_until("it is docked", lambda: page.locator(".dv-resize-container").count() == 0)
    page.get_by_role("button", name="Close Masses").click()
    wait_until("it is closed", lambda: panel_tab(tab, "Masses").count() == 0)


def test_a_panel_that_is_opened_behind_a_view_alone_is_there_afterwards(tab: StudioPage):
    tab.page.keyboard.press("F11")
    leave = tab.page.get_by_role("button", name="Leave full screen")
    leave.wait_for()
    tab.page.evaluate(_OPEN_VIEWS)
    leave.click()
    wait_until("its tab", lambda: panel_tab(tab, "Views").count() == 1)


def test_the_3d_view_fills_the_screen_and_gives_it_back(tab: StudioPage):
    page = tab.page
    bar, view = page.locator(".top-bar"), page.locator("iframe")
    before = view.bounding_box()
    assert before is not None

    def is_as_before() -> bool:
        now = view.bounding_box()
        return now is not None and max(map(abs, shift(before, now))) <= 1

    page.get_by_role("button", name="Full screen").click()
    bar.wait_for(state="hidden")
    full = {"x": 0, "y": 0, "width": VIEWPORT["width"], "height": VIEWPORT["height"]}
    wait_until("the view is all", lambda: view.bounding_box() == full)
    page.get_by_role("button", name="Leave full screen").click()
    wait_until("all is as before", is_as_before)
    page.keyboard.press("F11")
    bar.wait_for(state="hidden")
    page.keyboard.press("Escape")
    bar.wait_for()
    wait_until("all is as before once more", is_as_before)
    for key in ("F11", "Escape", "F11", "Escape"):  # faster than a browser's full screen begins
        page.keyboard.press(key)
    wait_until("all is as before at last", is_as_before)
    wait_until("it has ended", lambda: page.evaluate("document.fullscreenElement === null"))
