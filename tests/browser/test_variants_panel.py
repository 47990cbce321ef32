"""Variants as a person uses them: kept, switched, compared, and seen as a ghost."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
import yaml

from tests.support.studio_page import StudioPage, studio_page, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]


def show(tab: StudioPage, name: str) -> None:
    tab.page.get_by_role("tab", name=name).click()


def panel(tab: StudioPage) -> Locator:
    return tab.page.get_by_role("region", name="Variants")


def radius(tab: StudioPage) -> str:
    show(tab, "Properties")
    tab.seek("wheel_radius")
    text = tab.box("wheel_radius").input_value()
    show(tab, "Variants")
    return text


def save(tab: StudioPage, name: str) -> None:
    show(tab, "Variants")
    panel(tab).get_by_role("button", name="Save as variant").click()
    form = panel(tab).get_by_role("form", name="New variant")
    form.get_by_label("Name").fill(name)
    form.get_by_label("Note").fill("For tall grass")
    form.get_by_role("button", name="Save").click()
    panel(tab).get_by_role("button", name=name, pressed=True).wait_for()


def switch(tab: StudioPage, name: str) -> None:
    panel(tab).get_by_title(f"Switch to: {name}").click()
    panel(tab).get_by_role("button", name=name, pressed=True).wait_for()


def look_as_a_viewer(browser: Browser, studio: RunningStudio, radii: list[str]) -> None:
    """Whoever only looks sees the list and the comparison, and can change neither."""
    with studio_page(browser, studio, view=False, viewer=True) as viewer:
        show(viewer, "Variants")
        given = panel(viewer).get_by_role("row", name="wheel_radius property")
        given.wait_for()
        wait_until("both", lambda: given.get_by_role("cell").all_inner_texts() == radii)
        switches = panel(viewer).get_by_title("Only whoever has control can switch")
        assert [one.is_disabled() for one in switches.all()] == [True, True]
        for name in ("Save as variant…", "Over", "End the comparison"):
            assert panel(viewer).get_by_role("button", name=name).is_disabled()
        assert viewer.errors == []


def compare(tab: StudioPage, was: str, now: str) -> None:
    """Compare the robot of the file with the variant: what was given, and one wheel's radius."""
    panel(tab).get_by_role("button", name="More for Big wheels").click()
    tab.page.get_by_role("menuitem", name="Compare with the current robot").click()
    given = panel(tab).get_by_role("row", name="wheel_radius property")
    given.wait_for()
    wait_until("both", lambda: given.get_by_role("cell").all_inner_texts() == [was, now])
    search = panel(tab).get_by_role("searchbox", name="Filter differences")
    search.fill("front_left_wheel radius")
    wheel = panel(tab).get_by_role("row", name="Collision 1 radius")
    wait_until("the row of the radius", lambda: wheel.count() == 1)
    cells = wheel.get_by_role("cell").all_inner_texts()
    assert (cells[:2], cells[2][0]) == ([was, now], "+")


def select_wheel(tab: StudioPage) -> None:
    """A click on a part selects it; afterwards nothing is selected, nor under the pointer."""
    panel(tab).get_by_role("button", name="front_left_wheel", exact=True).click()
    tab.page.get_by_role("complementary", name="front_left_wheel").wait_for()
    tab.page.keyboard.press("Escape")
    tab.page.mouse.move(5, 5)


def see_ghost(tab: StudioPage, plain: bytes) -> None:
    """The ghost changes the picture, and leaves nothing behind."""
    tab.show_again(plain)
    panel(tab).get_by_role("button", exact=True, name="Over").click()
    tab.show_other_than(plain)
    panel(tab).get_by_role("button", exact=True, name="Off").click()
    tab.show_again(plain)


def test_a_variant_is_saved_switched_compared_and_seen(
    tab: StudioPage, browser: Browser, studio: RunningStudio, data: Path
):
    show(tab, "Variants")
    panel(tab).get_by_text("No variants yet").wait_for()
    was = radius(tab)
    show(tab, "Properties")
    now = tab.drag_slider("wheel_radius", 0.8)
    save(tab, "Big wheels")
    (file,) = data.rglob("rover.variants.yaml")
    (kept,) = yaml.safe_load(file.read_text())["variants"]
    assert (kept["name"], kept["values"][0]["text"]) == ("Big wheels", now)

    switch(tab, "As in the file")
    assert radius(tab) == was
    compare(tab, was, now)
    look_as_a_viewer(browser, studio, [was, now])
    tab.page.mouse.move(5, 5)
    plain = tab.settle()
    select_wheel(tab)
    see_ghost(tab, plain)

    switch(tab, "Big wheels")
    panel(tab).get_by_text("The robots are the same.").wait_for()
    assert radius(tab) == now
    tab.page.get_by_role("button", name="Undo", exact=True).click()
    panel(tab).get_by_role("button", name="As in the file", pressed=True).wait_for()
    assert tab.errors == []
