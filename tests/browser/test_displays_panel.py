"""The Displays panel by RViz's habits: nested groups, statuses, what is removed comes back."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from tests.support.studio_page import StudioPage, wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Locator

    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

ADD_AXES = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay } = await import(new URL("../model/live-displays.js", script));
  for (let count = 0; count < 3; count += 1) await addDisplay("Axes");
}"""
"""They listen to no topic, so that nothing is connected for them."""
LOSE_FRAME = """async (frame) => {
  const script = document.querySelector('script[type="module"]').src;
  const { liveDisplays, setProperty } = await import(new URL("../model/live-displays.js", script));
  const { id } = liveDisplays.value.find(({ name }) => name === "Axes 2");
  await setProperty(id, "Reference Frame", frame);
}"""


@pytest.fixture
def tab(shared: SharedTab) -> StudioPage:
    shared.anew()
    return shared.opened(view=False)


def row(tab: StudioPage, name: str) -> Locator:
    """The row of a display or a group."""
    named = re.compile(rf"^{name}(,|$)")
    return tab.page.locator("[id^='row-display:'], [id^='row-group:']").and_(
        tab.page.get_by_role("treeitem", name=named)
    )


def rows(tab: StudioPage) -> list[str]:
    """Displays and groups as they are listed, each with its level."""
    found = tab.page.locator("[id^='row-display:'], [id^='row-group:']").evaluate_all(
        "rows => rows.map((row) => [row.ariaLabel.split(',')[0], row.ariaLevel])"
    )
    return [f"{level} {name}" for name, level in found]


def become(tab: StudioPage, *expected: str) -> None:
    wait_until(" / ".join(expected), lambda: rows(tab) == list(expected))


def into_a_new_group(tab: StudioPage, name: str, group: str) -> None:
    """By the menu of its row, which a key opens."""
    row(tab, name).focus()
    tab.page.keyboard.press("Shift+F10")
    tab.page.get_by_role("menuitem", name="Into a group").click()
    tab.page.get_by_role("menuitem", name="New group").click()
    box = tab.page.get_by_role("textbox", name="Name of Group 1")
    box.fill(group)
    box.press("Enter")


def middle(part: Locator) -> tuple[float, float]:
    box = part.bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag_by_mouse(tab: StudioPage, name: str, onto: str) -> None:
    mouse, (x, y) = tab.page.mouse, middle(row(tab, name).locator(".tree-label"))
    to_x, to_y = middle(row(tab, onto).locator(".tree-label"))
    mouse.move(x, y)
    mouse.down()
    for step in range(4, -1, -1):
        mouse.move(to_x - step, to_y + step)
    tab.page.locator(".drop-into").wait_for()
    mouse.up()


def drag_by_finger(tab: StudioPage, name: str, above: str) -> None:
    """At its icon, to the upper end of another row."""
    with tab.finger() as touch:
        begin, (to_x, to_y) = middle(row(tab, name).locator("> .icon")), middle(row(tab, above))
        touch("touchStart", begin)
        for step in range(4, -1, -1):
            touch("touchMove", (to_x, to_y - 11 + step))
        tab.page.locator(".drop-before").wait_for()
        touch("touchEnd")


def test_displays_are_grouped_dragged_renamed_and_removed_as_in_rviz(tab: StudioPage):
    page = tab.page
    page.get_by_role("treeitem", name="Robot model").click()  # its links would stand between
    page.evaluate(ADD_AXES)
    become(tab, "1 Axes", "1 Axes 2", "1 Axes 3")
    into_a_new_group(tab, "Axes 2", "Arm")
    become(tab, "1 Axes", "1 Arm", "2 Axes 2", "1 Axes 3")
    row(tab, "Axes 3").focus()
    page.keyboard.press("Alt+ArrowRight")
    become(tab, "1 Axes", "1 Arm", "2 Axes 2", "2 Axes 3")
    row(tab, "Axes 3").focus()
    page.keyboard.press("Alt+ArrowUp")
    become(tab, "1 Axes", "1 Arm", "2 Axes 3", "2 Axes 2")
    into_a_new_group(tab, "Arm", "All")
    become(tab, "1 Axes", "1 All", "2 Arm", "3 Axes 3", "3 Axes 2")
    drag_by_mouse(tab, "Axes", onto="All")
    become(tab, "1 All", "2 Arm", "3 Axes 3", "3 Axes 2", "2 Axes")
    drag_by_finger(tab, "Axes", above="Arm")
    become(tab, "1 All", "2 Axes", "2 Arm", "3 Axes 3", "3 Axes 2")
    drag_by_finger(tab, "Arm", above="All")
    become(tab, "1 Arm", "2 Axes 3", "2 Axes 2", "1 All", "2 Axes")

    row(tab, "Axes").locator(".tree-label").dblclick()
    box = page.get_by_role("textbox", name="Name of Axes", exact=True)
    box.fill("Origin")
    box.press("Enter")
    become(tab, "1 Arm", "2 Axes 3", "2 Axes 2", "1 All", "2 Origin")
    row(tab, "Arm").focus()
    page.keyboard.press("Delete")
    become(tab, "1 All", "2 Origin")
    page.locator(".notice").get_by_role("button", name="Undo").click()
    become(tab, "1 Arm", "2 Axes 3", "2 Axes 2", "1 All", "2 Origin")

    row(tab, "Origin").focus()
    page.keyboard.press("Control+d")
    become(tab, "1 Arm", "2 Axes 3", "2 Axes 2", "1 All", "2 Origin", "2 Origin 2")

    page.get_by_role("button", name="Hide all displays").click()
    wait_until("all are hidden", lambda: page.locator(".tree-row.display.faded").count() == 4)
    page.get_by_role("button", name="Show all displays").click()
    wait_until("all are shown", lambda: page.locator(".tree-row.display.faded").count() == 0)
    see_statuses(tab)
    assert tab.errors == []


def see_statuses(tab: StudioPage) -> None:
    """A display that has no place, and its group while it is folded, have the colour of it."""
    page, faulty = tab.page, tab.page.locator(".tree-row.display.level-error")
    page.evaluate(LOSE_FRAME, "nowhere")
    wait_until("the display is faulty", lambda: faulty.count() == 1)
    row(tab, "Arm").click()
    page.locator(".tree-row.group .tree-meta.error").wait_for()
    row(tab, "Arm").click()
    row(tab, "Axes 2").click()
    status = page.get_by_role("treeitem", name="Status: Error", exact=True)
    line = page.locator(".tree-note.error").filter(has_text="Transform:")
    line.wait_for()
    status.click()
    wait_until("the status is folded", lambda: line.count() == 0)
    page.evaluate(LOSE_FRAME, "<Fixed Frame>")
    well = page.get_by_role("treeitem", name="Status: Ok", exact=True)
    well.click()
    page.get_by_role("treeitem", name="Transform, Ok").wait_for()
    page.get_by_role("treeitem", name="Global Status: Ok").wait_for()
    page.get_by_role("textbox", name="Axes 2: Length").click()
    page.get_by_role("complementary", name="What the current row means").wait_for()
