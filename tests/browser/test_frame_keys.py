"""The frame without a pointer: the palette, layouts of one's own, and names that are read out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.panel_pictures import DIALOGS, PANEL_IDS, SHOW_PANEL
from tests.support.studio_page import VIEWPORT, StudioPage, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.support.shared_tab import SharedTab


pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

_GROUPS = """() => [...document.querySelectorAll(".dv-groupview")].map((group) =>
  [...group.querySelectorAll('.dv-tabs-container [role="tab"]')].map(
    (tab) => tab.querySelector(".tab-label")?.textContent))"""
_NAMELESS = """() => {
  const words = (one) => (one.getAttribute("aria-labelledby") ?? "").split(/\\s+/)
    .map((id) => id && document.getElementById(id)?.textContent).join(" ");
  const name = (one) => [one.getAttribute("aria-label"), words(one), one.title, one.alt,
    one.placeholder, one.innerText, ...[...(one.labels ?? [])].map((label) => label.innerText),
    one.closest(".cm-editor") && "editor"].find((text) => text?.trim());
  const controls = `button, a[href], input, select, textarea, [tabindex="0"], [role="button"],
    [role="tab"], [role="treeitem"], [role="slider"], [role="switch"], [role="option"], iframe`;
  return [...document.querySelectorAll(controls)]
    .filter((one) => one.checkVisibility() && one.type !== "hidden" && !name(one))
    .map((one) => one.outerHTML.slice(0, 160));
}"""
_FOCUSED = """() => document.activeElement.getAttribute("aria-label")
  ?? document.activeElement.innerText.trim()"""
_NESTED = """() => [...document.querySelectorAll("button button, button a, a button, a a")]
  .map((one) => one.outerHTML.slice(0, 120))"""
_FIRST_LAYOUT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../lib/commands.js", script))).commandById("layout.0").run();
  await new Promise((done) => setTimeout(done, 250));
}"""
"""What changes within 200 ms of that is not remembered as the person's."""


@pytest.fixture(scope="module")
def opened(shared: SharedTab) -> StudioPage:
    """One tab, with an empty 3D view."""
    shared.anew()
    return shared.opened(view=False)


@pytest.fixture
def tab(opened: StudioPage) -> Iterator[StudioPage]:
    """That tab, with its panels where they were at first."""
    opened.page.set_viewport_size(VIEWPORT)
    opened.page.evaluate(_FIRST_LAYOUT)
    opened.page.locator(".cm-line").first.wait_for()
    yield opened
    assert opened.errors == []


def groups(tab: StudioPage) -> list[list[str]]:
    return tab.page.evaluate(_GROUPS)


def search(tab: StudioPage, words: str) -> None:
    """Open the palette by its key and type."""
    tab.page.keyboard.press("Control+k")
    tab.page.keyboard.type(words)
    wait_until(
        f"something that fits {words}",
        lambda: tab.page.locator('.palette-item[aria-selected="true"]').count() == 1,
    )


def test_the_palette_goes_to_a_property_by_some_of_its_letters(tab: StudioPage):
    search(tab, "whrad")
    assert tab.page.locator(".palette-item").first.locator("mark").count() == 2
    tab.page.keyboard.press("Enter")
    box = tab.box("wheel_radius")
    wait_until("its box to have the focus", lambda: box.evaluate("it => it.matches(':focus')"))
    tab.page.keyboard.press("Control+k")
    used = tab.page.get_by_role("group", name="Recently used").get_by_role("option")
    assert "wheel_radius" in used.first.inner_text()
    tab.page.keyboard.press("Escape")


def test_the_palette_explains_a_line_of_a_shell_and_mends_one_of_ros2(tab: StudioPage):
    search(tab, "colcon build --symlink-install")
    said = tab.page.locator(".palette-does").inner_text()
    assert "Not needed here" in said
    tab.page.keyboard.press("Enter")
    tab.page.get_by_role("status").get_by_text("Not needed here").wait_for()
    search(tab, "ros2 topic ehco /chatter")
    assert (
        tab.page.locator(".palette-item").first.inner_text().startswith("ros2 topic echo /chatter")
    )
    tab.page.keyboard.press("Escape")


def test_the_palette_goes_to_links_joints_and_lines(tab: StudioPage):
    search(tab, "@mast")
    tab.page.keyboard.press("Enter")
    row = tab.page.get_by_role("treeitem", name="mast", exact=True)
    wait_until("the link to be selected", lambda: row.get_attribute("aria-selected") == "true")
    search(tab, "@mast_pan")
    tab.page.keyboard.press("Enter")
    tab.page.get_by_role("tab", name="Joints", selected=True).wait_for()
    search(tab, ":25")
    tab.page.keyboard.press("Enter")
    tab.page.get_by_text("Line 25, column 1").wait_for()


def test_a_panel_moves_by_keys_and_the_layout_comes_back_by_its_name(tab: StudioPage):
    first = groups(tab)
    tab.page.get_by_role("tab", name="Variants").click()
    tab.page.get_by_role("tab", name="Variants", selected=True).wait_for()
    tab.page.keyboard.press("Control+Shift+M")
    tab.page.get_by_role("menuitem", name="At the left edge").focus()
    tab.page.keyboard.press("Enter")
    wait_until("a place of its own", lambda: groups(tab)[0] == ["Variants"])
    focused = "document.activeElement.textContent.trim()"
    wait_until("its focus kept", lambda: tab.page.evaluate(focused) == "Variants")
    search(tab, ">layouts")
    tab.page.keyboard.press("Enter")
    tab.page.get_by_label("Name of the current layout").fill("Variants <b>aside</b>")
    tab.page.keyboard.press("Enter")
    tab.page.get_by_role("button", name="Variants <b>aside</b>", pressed=True).wait_for()
    tab.page.keyboard.press("Escape")
    mine = groups(tab)
    tab.page.keyboard.press("Control+1")
    wait_until("the studio's own layout", lambda: groups(tab) == first)
    tab.page.keyboard.press("Control+3")
    wait_until("the saved layout", lambda: groups(tab) == mine)
    tab.page.reload()
    wait_until("the saved layout again", lambda: groups(tab) == mine)


def test_a_panel_whose_words_come_with_it_stays_the_one_that_keys_are_for(tab: StudioPage):
    tab.page.set_viewport_size({"width": 720, "height": 640})
    tab.page.reload()  # it shall not be there yet
    tab.page.locator(".cm-line").first.wait_for()
    search(tab, "diagnostics")
    tab.page.keyboard.press("Enter")
    panel = tab.page.get_by_role("tabpanel", name="Diagnostics")
    panel.get_by_text("Not connected to ROS 2.").wait_for()
    active = tab.page.locator(".dv-active-group .dv-active-tab")
    assert active.inner_text() == "Diagnostics"


def test_layouts_travel_as_a_file_and_what_is_no_such_file_is_refused(
    tab: StudioPage, tmp_path: Path
):
    search(tab, ">layouts")
    tab.page.keyboard.press("Enter")
    tab.page.get_by_label("Name of the current layout").fill("Mine")
    tab.page.keyboard.press("Enter")
    with tab.page.expect_download() as download:
        tab.page.get_by_role("button", name="Save Mine as a file").click()
    saved = tmp_path / "mine.json"
    download.value.save_as(saved)
    tab.page.get_by_role("button", name="Delete Mine").click()
    chooser = tab.page.locator("dialog input[type=file]")
    foreign = saved.read_text().replace('"urdf"', '"teapot"')
    saved.write_text(foreign)
    chooser.set_input_files(saved)
    tab.page.get_by_role("button", name="Mine", exact=True).wait_for()
    assert "were left out: teapot" in tab.page.locator(".notices").inner_text()
    saved.write_text("[1, 2")
    chooser.set_input_files(saved)
    tab.page.get_by_text("mine.json is not a JSON file").wait_for()
    tab.page.keyboard.press("Escape")


def test_the_focus_goes_back_to_where_a_window_was_opened_from(tab: StudioPage):
    button = tab.page.get_by_role("button", name="Settings")
    button.click()
    tab.page.get_by_role("menuitem", name="Keyboard shortcuts").click()
    tab.page.get_by_role("dialog").wait_for()
    tab.page.keyboard.press("Escape")
    wait_until("the focus", lambda: button.evaluate("it => it === document.activeElement"))


def test_tab_begins_with_a_way_past_the_bar(tab: StudioPage):
    tab.page.reload()  # nothing had the focus yet
    tab.page.locator(".cm-line").first.wait_for()
    tab.page.evaluate("document.activeElement.blur()")
    tab.page.keyboard.press("Tab")
    link = tab.page.get_by_role("link", name="Skip to the panels")
    assert link.evaluate("it => it === document.activeElement")
    tab.page.keyboard.press("Enter")
    focused = "document.activeElement.getAttribute('role')"
    wait_until("the focus on a panel", lambda: tab.page.evaluate(focused) == "tab")


def test_every_control_of_every_panel_and_window_has_a_name(tab: StudioPage):
    tab.page.get_by_role("treeitem", name="upper_arm", exact=True).click()
    for name in tab.page.evaluate(PANEL_IDS):
        tab.page.evaluate(SHOW_PANEL, name)
        wait_until(f"{name}", lambda: tab.page.locator(".panel > .progress").count() == 0)
        assert tab.page.evaluate(_NAMELESS) == [], name
        assert tab.page.evaluate(_NESTED) == [], name
    for name, key in DIALOGS.items():
        tab.page.get_by_role("link", name="Studio: start page").focus()
        tab.page.keyboard.press(key)
        tab.page.get_by_role("dialog").wait_for()
        assert tab.page.evaluate(_NAMELESS) == [], name
        tab.page.keyboard.press("Escape")
        tab.page.get_by_role("dialog").wait_for(state="detached")


def test_a_closed_3d_view_stays_closed_and_comes_back_when_asked_for_with_its_buttons(
    tab: StudioPage,
):
    tab.page.get_by_role("tab", name="3D view").click(button="right")
    tab.page.get_by_role("menuitem", name="Close").click()
    wait_until("it to be gone", lambda: tab.page.locator("iframe").count() == 0)
    tab.page.context.clear_cookies(name="without_view")
    tab.page.reload()
    tab.page.get_by_role("treeitem", name="mast", exact=True).wait_for()
    assert tab.page.locator("iframe").count() == 0
    search(tab, "3d view")
    tab.page.keyboard.press("Enter")
    wait_until("the robot", tab.has_drawn_robot)
    tab.page.evaluate(_FIRST_LAYOUT)
    tab_goes_from_the_3d_view_to_its_own_buttons_and_back(tab)


def tab_goes_from_the_3d_view_to_its_own_buttons_and_back(tab: StudioPage) -> None:
    tab.page.get_by_role("tab", name="3D view").focus()
    there = pressed(tab, "Tab", 12)
    assert (there[0], there[3]) == ("Help: 3D view", "Close 3D view")
    assert "Fit" in there[4:]
    back = pressed(tab, "Shift+Tab", 12)
    assert back == ["3D view", *there[:-1]][::-1]


def pressed(tab: StudioPage, key: str, times: int) -> list[str]:
    """What has the focus after each press."""
    names: list[str] = []
    for _ in range(times):
        tab.page.keyboard.press(key)
        names.append(tab.page.evaluate(_FOCUSED))
    return names
