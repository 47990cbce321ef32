"""Where a part comes from, asked, followed and edited in the page; what a text shapes lights up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.studio_page import StudioPage, studio_page, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio
    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

_WHEEL_AT = """() => {
  const { studio3d, innerWidth, innerHeight } = document.querySelector("iframe").contentWindow;
  for (let y = innerHeight - 20; y > 20; y -= 6)
    for (let x = 20; x < innerWidth - 20; x += 6)
      if (studio3d.linkAt(x, y)?.endsWith("_wheel")) return [x, y];
  return null;
}"""


@pytest.fixture(scope="module")
def studio(shared: SharedTab) -> RunningStudio:
    return shared.anew()


@pytest.fixture(scope="module")
def opened(shared: SharedTab, studio: RunningStudio) -> StudioPage:
    """One tab for all tests of the file."""
    del studio  # as at first, before the tab opens it
    return shared.opened()


@pytest.fixture
def tab(opened: StudioPage) -> StudioPage:
    """The same, with nothing edited, and all properties in front."""
    opened.undo_all()
    opened.page.get_by_role("tab", name="Properties", exact=True).click()
    opened.page.get_by_role("searchbox", name="Filter properties").fill("")
    return opened


def panel(tab: StudioPage) -> Locator:
    return tab.page.locator("section[aria-label='Where from']")


def show(tab: StudioPage) -> None:
    tab.page.get_by_role("tab", name="Where from").click()
    wait_until("the panel", panel(tab).is_visible)


def mesh_scale(tab: StudioPage) -> Locator:
    element = panel(tab).get_by_role("region", name="visual[1]/geometry/mesh")
    return element.get_by_role("group", name="scale")


def test_a_clicked_wheel_tells_its_radius_which_is_edited_there(tab: StudioPage):
    show(tab)
    place = tab.page.evaluate(_WHEEL_AT)
    assert place is not None
    tab.page.locator("iframe").click(position={"x": place[0], "y": place[1]})
    wait_until("the wheel's numbers", lambda: mesh_scale(tab).count() == 1)
    scale = mesh_scale(tab)
    assert "${wheel_radius} ${wheel_radius} ${wheel_width}" in scale.inner_text()
    before = tab.settle()
    scale.get_by_role("button", name="wheel_radius").click()
    box = tab.row("wheel_radius").get_by_role("textbox").first
    box.fill("0.2")
    box.press("Enter")
    wait_until("the number", lambda: "0.2  0.2  0.114286" in scale.inner_text())
    tab.show_other_than(before)
    panel(tab).get_by_role("button", name="wheel.xacro:", exact=False).first.click()
    line = tab.page.locator(".cm-activeLine")
    wait_until("its line", lambda: line.count() > 0 and "wheel" in line.inner_text())
    assert tab.errors == []


def test_a_pointed_at_property_lights_up_what_it_shapes_and_says_so(tab: StudioPage):
    tab.seek("wheel_width")
    dark = tab.plain_picture()
    tab.row("wheel_width").hover()
    words = tab.page.get_by_role("status").filter(has_text="wheel_width")
    wait_until("the words", lambda: words.count() == 1)
    assert "resizes 5 links, moves 4 links" in words.inner_text()
    tab.show_other_than(dark)
    tab.page.mouse.move(5, 5)
    wait_until("the words to go", lambda: words.count() == 0)
    tab.show_again(dark)
    tab.box("wheel_width").focus()
    wait_until("the words by keyboard", lambda: words.count() == 1)
    tab.row("wheel_width").get_by_role("button", name="More").click()
    tab.page.get_by_role("menuitem", name="Show in the source").click()
    tab.page.get_by_role("searchbox", name="Filter properties").focus()
    wait_until("the words to go again", lambda: words.count() == 0)
    tab.page.locator(".cm-activeLine", has_text="wheel_width").hover()
    wait_until("the words from the source", lambda: words.count() == 1)
    assert tab.errors == []


def test_the_values_of_a_link_are_all_that_shape_it(tab: StudioPage):
    tab.page.get_by_role("treeitem", name="front_left_wheel").click()
    tab.page.get_by_role("button", name="Show its values").click()
    wait_until("what its macro reads", lambda: tab.row("wheel_radius").count() == 1)
    assert tab.row("wheel_base").count() == 1
    assert tab.row("cameras").count() == 0


def test_an_element_of_the_urdf_leads_to_its_number(tab: StudioPage):
    tab.page.get_by_role("tab", name="URDF", exact=True).click()
    tab.page.locator("section[aria-label='URDF']").get_by_role("button", name="Find").click()
    tab.page.keyboard.type("upper=")
    tab.page.keyboard.press("Enter")
    limit = tab.page.locator(".urdf-text .cm-line", has_text="upper=").first
    wait_until("the URDF", lambda: limit.count() == 1)
    limit.locator(".source-name", has_text="upper").click()
    chosen = panel(tab).locator(".origin-attribute.chosen")
    wait_until("the number", lambda: chosen.count() == 1)
    assert chosen.get_attribute("aria-label") == "upper"
    assert panel(tab).get_by_role("button", pressed=True).first.inner_text().endswith("_joint")


def test_whoever_only_watches_sees_origins_and_cannot_edit_there(
    browser: Browser, studio: RunningStudio
):
    with studio_page(browser, studio, view=False, viewer=True) as viewer:
        show(viewer)
        viewer.page.get_by_role("treeitem", name="front_left_wheel").click()
        wait_until("the wheel's numbers", lambda: mesh_scale(viewer).count() == 1)
        mesh_scale(viewer).get_by_role("button", name="wheel_radius").click()
        wait_until("its row", lambda: viewer.row("wheel_radius").count() == 1)
        assert viewer.box("wheel_radius").is_disabled()
        assert viewer.errors == []
