"""The tool Select and the Selection panel: from what is drawn in 3D to the fields of a message."""

from __future__ import annotations

import math
import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

import pytest
from playwright.sync_api import expect

from studio.ros.messages import message
from studio.ros.types.convert import from_dict
from tests.support.demos import node_at
from tests.support.display_messages import point, pose
from tests.support.display_samples import BASE, SAMPLES
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until
from tests.support.told_samples import told
from tests.support.wire import free_endpoint, router_at
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator, ViewportSize

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

WIDE: Final[ViewportSize] = {"width": 1400, "height": 800}
MARKER: Final = "visualization_msgs/msg/Marker"
CLOUD: Final = next(one for one in SAMPLES if one.name == "cloud_intensity")
MAP: Final = next(one for one in SAMPLES if one.name == "map")
_ADD = """async ([kind, topic]) => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay, liveDisplays } = await import(new URL("../model/live-displays.js", script));
  await addDisplay(kind, topic);
  return liveDisplays.value.at(-1).id;
}"""
_LOOK_DOWN = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { viewport } = await import(new URL("../model/viewport.js", script));
  viewport.value.setCamera({ position: [0, -0.001, 6], target: [0, 0, 0] });
}"""
_IN_HAND = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/tools.js", script))).toolInHand.value?.kind;
}"""
_EYE = """() => {
  const { camera } = document.querySelector("iframe").contentWindow.__viserMutable;
  return [camera.matrixWorld.elements[9], camera.position.length()];
}"""
"""How far the camera looks down, 1 at most, and how far it is from the origin, m."""
_PLACE = """([node, place]) => {
  const frame = document.querySelector("iframe");
  const { __viserMutable: viser } = frame.contentWindow;
  const object = viser.nodeRefFromName[node];
  const hasShapes = Object.entries(viser.nodeRefFromName)
    .some(([name, shape]) => shape && name.startsWith(`${node}/`));
  if (!object?.visible || !hasShapes) return null;
  object.updateWorldMatrix(true, false);
  const seen = viser.camera.position.clone().set(...place).applyMatrix4(object.matrixWorld)
    .project(viser.camera);
  const { left, top } = frame.getBoundingClientRect();
  const { clientWidth: width, clientHeight: height } = viser.canvas;
  return [left + (seen.x + 1) / 2 * width, top + (1 - seen.y) / 2 * height];
}"""


@pytest.fixture
def endpoint() -> Generator[str]:
    with router_at(free_endpoint()) as router:
        yield router.endpoint.text


@pytest.fixture
def studio(endpoint: str, tmp_path: Path) -> Generator[RunningStudio]:
    words = ["demo", "--connect", endpoint, "--router", "off"]
    with running_studio(words, tmp_path / "data") as running:
        yield running


@contextmanager
def cube_teller(endpoint: str) -> Generator[Callable[[float, int], None]]:
    """Publishes two cubes, 1 m apart along y from a place on x; the last one may be deleted."""
    with node_at(endpoint, "cubes") as node:
        kind = message(MARKER)
        publisher = node.create_publisher(kind, "/cubes", 10)

        def tell(x: float, last_action: int = 0) -> None:
            for number, action in ((1, 0), (2, last_action)):
                fields: dict[str, Any] = {
                    "header": {"frame_id": BASE, "stamp": {"sec": 0, "nanosec": 0}},
                    "ns": "cubes", "id": number, "type": 1, "action": action,
                    "pose": pose((x, float(number - 1), 0.5)), "scale": point(0.2, 0.2, 0.2),
                    "color": {"r": 1.0, "g": 0.5, "b": 0.0, "a": 1.0}, "frame_locked": True,
                }  # fmt: skip
                publisher.publish(from_dict(kind, fields))

        yield tell


class Selecting:
    """A tab with the tool Select in hand, which looks down from 6 m, and the panel in front."""

    def __init__(self, tab: StudioPage, **displays: tuple[str, str]) -> None:
        self.page, self.finger = tab.page, tab.finger
        self.page.set_viewport_size(WIDE)
        connect(tab)
        self.ids = {name: self.page.evaluate(_ADD, list(one)) for name, one in displays.items()}
        self.page.evaluate(SHOW_PANEL, "selection")
        self.look_down()
        self.page.keyboard.press("s")
        wait_until("the tool is in hand", lambda: self.page.evaluate(_IN_HAND) == "Select")
        self.panel = self.page.locator("section.selection")

    def look_down(self) -> None:
        """From 6 m above; the picture after the next one is seen from there."""
        self.page.evaluate(_LOOK_DOWN)
        wait_until("the camera is above", lambda: self.eye()[0] > 0.999 and self.eye()[1] > 5)

    def eye(self) -> tuple[float, float]:
        down, distance_m = self.page.evaluate(_EYE)
        return down, distance_m

    def place(self, display: str, path: str, x: float, y: float, z: float) -> tuple[float, float]:
        """Where a place in the frame of a group is on the page."""
        node = f"/live/{self.ids[display]}/{path}"
        found: list[Any] = []

        def rests() -> bool:
            """It is drawn, and the camera has arrived."""
            found.append(self.page.evaluate(_PLACE, [node, [x, y, z]]))
            return found[-1] is not None and found[-4:-1] == [found[-1]] * 3

        wait_until(f"{node} is drawn and rests", rests)
        return found[-1][0], found[-1][1]

    def click(self, place: tuple[float, float], *keys: str) -> None:
        for key in keys:
            self.page.keyboard.down(key)
        self.page.mouse.click(*place)
        for key in keys:
            self.page.keyboard.up(key)

    def drag(self, begin: tuple[float, float], end: tuple[float, float]) -> None:
        self.page.mouse.move(*begin)
        self.page.mouse.down()
        self.page.mouse.move(*end, steps=3)
        self.page.mouse.up()

    def item(self, name: str) -> Locator:
        return self.panel.get_by_role("treeitem", name=name, exact=True)

    def fact(self, item: str, name: str) -> Locator:
        """The value that stands beside a name, the first of an item."""
        row = (
            self.item(item).locator("dl > div").filter(has=self.page.get_by_text(name, exact=True))
        )
        return row.locator("dd").first

    def expect_count(self, words: str) -> None:
        expect(self.panel.get_by_role("status").first).to_have_text(words)


def test_a_point_a_cell_and_a_marker_are_selected_by_clicks_and_many_kinds_by_a_rectangle(
    browser: Browser, studio: RunningStudio, endpoint: str
):
    with (
        told(endpoint, [CLOUD, MAP]),
        cube_teller(endpoint) as tell,
        studio_page(browser, studio) as tab,
    ):
        view = Selecting(
            tab, cloud=("PointCloud2", CLOUD.topic), map=("Map", MAP.topic),
            cubes=("Marker", "/cubes"),
        )  # fmt: skip
        expect(view.panel).to_contain_text("Nothing is selected")
        select_a_point(view)
        select_a_cell(view)
        follow_a_marker(view, tell)
        select_by_finger(view)
        select_in_a_rectangle(view)


def select_a_point(view: Selecting) -> None:
    """The point in column 88 and row 80 of 130, where the cloud is above the map."""
    index = 80 * 130 + 88
    x, y = -1.5 + 88 * 3 / 129, -1.5 + 80 * 3 / 129
    z = 0.2 * math.sin(3 * x) * math.cos(2 * y) - 0.1
    view.click(view.place("cloud", "0", x, y, z))
    name = f"Point {index}"
    expect(view.fact(name, "Index")).to_have_text(str(index))
    expect(view.fact(name, "intensity")).to_contain_text(f"{math.hypot(x, y):.4f}"[:5])
    expect(view.fact(name, "Frame")).to_have_text(BASE)
    view.expect_count("1 selected")


def select_a_cell(view: Selecting) -> None:
    """A cell of the part that nobody saw, where the cloud is below the map."""
    view.click(view.place("map", "map", -1.237, 1.113, 0))
    expect(view.fact("Cell 104, 10", "Value")).to_have_text("-1")
    expect(view.fact("Cell 104, 10", "Row")).to_have_text("104")
    expect(view.panel.get_by_role("treeitem")).to_have_count(2)


def follow_a_marker(view: Selecting, tell: Callable[[float, int], None]) -> None:
    """It keeps its row when it moves, and is gone when it is deleted."""
    told_until_drawn(view, tell, 1.0)
    view.click(view.place("cubes", "g0", 1.0, 1.0, 0.6))
    expect(view.fact("Marker cubes/2", "Type")).to_have_text("CUBE")
    expect(view.fact("Marker cubes/2", "Position")).to_contain_text("11")
    tell(-1.0, 0)
    expect(view.fact("Marker cubes/2", "Position")).to_contain_text("-1")
    tell(-1.0, 2)
    expect(view.item("Marker cubes/2")).to_contain_text("gone")


def told_until_drawn(view: Selecting, tell: Callable[[float, int], None], x: float) -> None:
    """A display may begin to listen after a message was published."""
    node = f"/live/{view.ids['cubes']}/g0"

    def is_drawn() -> bool:
        tell(x, 0)
        return view.page.evaluate(_PLACE, [node, [0, 0, 0]]) is not None

    wait_until("the cubes are drawn", is_drawn)


def select_by_finger(view: Selecting) -> None:
    """A tap takes a cell, a stroke a rectangle; the camera stands still."""
    with view.finger(coarse=False) as touch:
        cell, eye = view.place("map", "map", -1.237, 1.113, 0), view.eye()
        touch("touchStart", cell)
        touch("touchEnd")
        expect(view.item("Cell 104, 10")).to_be_visible()
        view.expect_count("1 selected")
        touch("touchStart", cell)
        for by_px in (10, 20, 30):
            touch("touchMove", (cell[0] + by_px, cell[1] + by_px))
        touch("touchEnd")
    expect(view.panel.get_by_role("status").first).to_have_text(re.compile(r"^[1-9]\d+ selected"))
    assert view.eye() == eye


def select_in_a_rectangle(view: Selecting) -> None:
    """Of the cloud, the map and the cube; with keys more and fewer."""
    around = (
        view.place("cubes", "g0", -1.15, -0.15, 0.5),
        view.place("cubes", "g0", -0.85, 0.15, 0.5),
    )
    view.drag(*around)
    kinds = view.panel.locator(".selection-group .selection-name")
    expect(kinds).to_have_text(["PointCloud2", "Map", "Marker"], timeout=20_000)
    expect(view.panel.get_by_role("status").first).to_have_text(re.compile(r"^\d{3} selected"))
    points = view.panel.get_by_role("treeitem", name=re.compile("^Point "))
    expect(points).to_have_count(0)
    view.item("PointCloud2").get_by_role("button").first.click()
    expect(points.first).to_be_visible()
    view.panel.get_by_role("button", name="Focus the camera on the selection").click()
    wait_until("the camera shows all of the map", lambda: view.eye()[1] > 7)
    view.look_down()
    cube = view.place("cubes", "g0", -1.0, 0.0, 0.6)
    view.click(cube)
    view.expect_count("1 selected")
    view.click(view.place("map", "map", -1.237, 1.113, 0), "Shift")
    view.expect_count("2 selected")
    expect(view.item("Cell 104, 10")).to_be_visible()
    view.click(cube, "Control")
    view.expect_count("1 selected")
    expect(view.item("Cell 104, 10")).to_be_visible()
    view.page.keyboard.press("Escape")
    expect(view.panel).to_contain_text("Nothing is selected")
