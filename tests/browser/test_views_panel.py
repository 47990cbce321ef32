"""The camera as RViz's views: the panel with its values and shelves, the cube, and the keys."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from tests.support.panel_pictures import SHOW_PANEL
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from playwright.sync_api import Locator

    from tests.support.shared_tab import SharedTab
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

VIEW = "() => document.querySelector('iframe').contentWindow.studio3d.getView()"
TURN = """() => {
  const { position, target, flat } =
    document.querySelector("iframe").contentWindow.studio3d.getCamera();
  const way = position.map((one, at) => one - target[at]);
  return { from: way.map((one) => one / Math.hypot(...way)), flat };
}"""
MODEL = """async (spec) => {
  const script = document.querySelector('script[type="module"]').src;
  const { currentView, useView } = await import(new URL("../model/views.js", script));
  if (spec) useView(spec, false);
  return currentView("now");
}"""


class Views:
    """The panel, and what the camera shows."""

    def __init__(self, tab: StudioPage) -> None:
        self.tab, self.page = tab, tab.page
        self.page.evaluate(SHOW_PANEL, "views")
        self.panel = self.page.get_by_role("region", name="Views").or_(self.page.locator(".views"))
        self.page.locator(".views").wait_for()

    def seen(self) -> dict[str, Any]:
        return self.page.evaluate(VIEW)

    def looks_from(self, *side: float) -> None:
        way = [one / math.hypot(*side) for one in side]
        wait_until(
            f"the camera at {side}",
            lambda: math.dist(self.page.evaluate(TURN)["from"], way) < 0.01,
        )

    def until(self, name: str, value: float) -> None:
        def met() -> bool:
            return abs(self.seen()["values"].get(name, math.inf) - value) < 1e-6

        wait_until(f"{name} to be {value}", met)

    def shelf(self, name: str) -> Locator:
        return self.page.locator(".views-shelf").filter(has_text=name)

    def write(self, name: str, number: str) -> None:
        box = self.page.locator(".views").get_by_role("textbox", name=name, exact=True)
        box.fill(number)
        box.press("Enter")

    def choose(self, shelf: str, view: str, what: str) -> None:
        self.shelf(shelf).get_by_role("button", name=f"What to do with {view}").click()
        self.page.get_by_role("menu").get_by_role("menuitem", name=what).click()


def change_values_and_kinds(views: Views) -> None:
    kind = views.page.get_by_label("Type")
    assert kind.input_value() == "Orbit"
    views.write("Yaw", "0.5")
    views.until("Yaw", 0.5)
    views.write("Pitch", "9")
    views.until("Pitch", math.pi / 2 - 0.001)
    views.write("Pitch", "0.25")
    views.write("Distance", "2")
    views.until("Distance", 2.0)
    views.looks_from(math.cos(0.5) * math.cos(0.25), math.sin(0.5) * math.cos(0.25), math.sin(0.25))
    kind.select_option("FPS")
    wait_until("an FPS", lambda: views.seen()["kind"] == "FPS")
    views.until("Pitch", 0.25)
    views.page.locator(".views").get_by_role("textbox", name="Position/X").wait_for()
    views.page.get_by_role("button", name="Back to the view before").click()
    wait_until("the Orbit again", lambda: views.seen()["kind"] == "Orbit")
    views.until("Yaw", 0.5)


def save_rename_use_and_delete(views: Views, shelf: str, save: str) -> None:
    views.page.get_by_role("button", name=save).click()
    row = views.shelf(shelf).get_by_role("button", name="Go to View 1")
    views.shelf(shelf).get_by_title("Go to View 1").wait_for()
    views.choose(shelf, "View 1", "Rename")
    views.page.get_by_label("Name of View 1").fill("From the side")
    views.page.keyboard.press("Enter")
    row = views.shelf(shelf).get_by_title("Go to From the side")
    row.wait_for()
    views.page.get_by_role("button", name="Zero", exact=True).click()
    views.until("Distance", 10.0)
    row.click()
    views.until("Distance", 2.0)
    views.choose(shelf, "From the side", "Delete")
    row.wait_for(state="detached")
    views.shelf(shelf).get_by_role("button", name="Undo").click()
    row.wait_for()


def use_the_cube(views: Views) -> None:
    cube = views.page.locator(".view-cube")
    cube.get_by_role("button", name="Front").click()
    views.looks_from(1, 0, 0)
    cube.locator(".front [data-to='1,0,1']").click()
    views.looks_from(1, 0, 1)
    cube.locator(".front [data-to='1,1,1']").hover()
    assert cube.locator(".marked").count() == 3
    cube.locator(".front [data-to='1,1,1']").click()
    views.looks_from(1, 1, 1)
    cube.get_by_role("button", name="Top").click()
    views.looks_from(0, 0, 1)
    cube.focus()
    for _ in range(2):
        views.page.keyboard.press("ArrowDown")
    views.looks_from(0, -1, 0)
    cube.and_(views.page.get_by_role("group", name="seen from “Right”")).wait_for()
    box = cube.bounding_box()
    assert box
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    views.page.mouse.move(x, y)
    views.page.mouse.down()
    views.page.mouse.move(x + 30, y, steps=3)
    views.page.mouse.up()
    yaw = 2 * math.pi - math.pi / 2 - 60 * 0.005
    views.until("Yaw", yaw)
    views.page.get_by_role("button", name="Standard views").click()
    views.page.get_by_role("menu").get_by_text("View cube").click()
    cube.wait_for(state="detached")


def use_the_keys(views: Views) -> None:
    words = "Orthographic: without perspective"
    views.page.locator(".views-shelf h3").first.click()  # out of all boxes
    views.page.keyboard.press("5")
    wait_until("no perspective", lambda: views.page.evaluate(TURN)["flat"])
    views.page.get_by_role("button", name=words, pressed=True).click()
    wait_until("perspective", lambda: not views.page.evaluate(TURN)["flat"])
    views.page.keyboard.press("z")
    views.until("Distance", 10.0)
    views.page.keyboard.press("f")
    wait_until("all in view", lambda: views.seen()["values"]["Distance"] < 5)


def give_and_take_a_view(views: Views) -> None:
    spec = {"kind": "TopDownOrtho", "name": "map", "values": {"Scale": 80.0, "X": 1.0}}
    now = views.page.evaluate(MODEL, spec)
    assert now == {**spec, "name": "now"}
    wait_until("the map", lambda: views.page.evaluate(TURN)["flat"])
    assert views.page.get_by_label("Type").input_value() == "TopDownOrtho"


def test_views_are_set_saved_and_chosen_by_panel_cube_and_keys(shared: SharedTab, tab: StudioPage):
    views = Views(tab)
    change_values_and_kinds(views)
    save_rename_use_and_delete(views, "With this robot", "Save the current view with the robot")
    save_rename_use_and_delete(views, "Mine", "Save the current view for me")
    use_the_cube(views)
    use_the_keys(views)
    give_and_take_a_view(views)
    again = Views(shared.opened())
    for shelf in ("With this robot", "Mine"):
        again.shelf(shelf).get_by_title("Go to From the side").wait_for()
    assert again.page.locator(".view-cube").count() == 0
    assert tab.errors == []
