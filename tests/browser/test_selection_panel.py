"""The tool Select and the Selection panel: by clicks and rectangles, from 3D to the fields of a message."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import pytest

from tests.support.display_samples import SAMPLES
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until
from tests.support.told_samples import told
from tests.support.wire import free_endpoint, router_at
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from playwright.sync_api import Browser, ViewportSize

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

WIDE: Final[ViewportSize] = {"width": 1400, "height": 800}
TOLD: Final = [one for one in SAMPLES if one.name in {"cloud_intensity", "map", "marker_array"}]
_ADD = """async ([kind, topic]) => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay, liveDisplays } = await import(new URL("../model/live-displays.js", script));
  await addDisplay(kind, topic);
  return liveDisplays.value.at(-1).id;
}"""
_SHOW = """async ([name, visible]) => {
  const script = document.querySelector('script[type="module"]').src;
  const { switchDisplay } = await import(new URL("../model/live-displays.js", script));
  await switchDisplay(name, visible);
}"""
_OPEN = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { viewport } = await import(new URL("../model/viewport.js", script));
  const { dock } = await import(new URL("../app/layouts.js", script)).catch(() => ({}));
  viewport.value.setTool("Select");
  viewport.value.setCamera({ position: [0, -0.001, 6], target: [0, 0, 0] });
}"""
_PLACE = """([node, place]) => {
  const frame = document.querySelector("iframe");
  const { __viserMutable: viser } = frame.contentWindow;
  const object = viser.nodeRefFromName[node];
  if (!object?.visible) return null;
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


class Selecting:
    """A tab with the tool Select in hand, seen from above."""

    def __init__(self, tab: StudioPage) -> None:
        self.tab, self.page = tab, tab.page
        self.page.set_viewport_size(WIDE)
        connect(tab)
        self.ids = {one.name: self.page.evaluate(_ADD, [one.kind, one.topic]) for one in TOLD}
        tab.page.get_by_role("button", name="Panels").click()

    def place(self, sample: str, path: str, xyz: tuple[float, float, float]) -> tuple[float, float]:
        """Where a place in the frame of a group is on the page."""
        node = f"/live/{self.ids[sample]}/{path}"
        found: list[Any] = []

        def is_there() -> bool:
            found.append(self.page.evaluate(_PLACE, [node, list(xyz)]))
            return found[-1] is not None

        wait_until(f"{node} is drawn", is_there)
        x, y = found[-1]
        return x, y


def test_trial(browser: Browser, studio: RunningStudio, endpoint: str):
    with told(endpoint, TOLD), studio_page(browser, studio) as tab:
        tab.page.set_viewport_size(WIDE)
        connect(tab)
        ids = {one.name: tab.page.evaluate(_ADD, [one.kind, one.topic]) for one in TOLD}
        print(ids)
        tab.page.evaluate(_OPEN)
        self = Selecting.__new__(Selecting)
        self.tab, self.page, self.ids = tab, tab.page, ids
        print(self.place("cloud_intensity", "0", (0, 0, 0)))
        import time

        time.sleep(3)
        print(
            tab.page.evaluate(
                """() => Object.keys(document.querySelector("iframe").contentWindow.__viserSceneTree.getState()).filter((n) => n.startsWith("/live"))"""
            )
        )
        x, y = self.place("cloud_intensity", "0", (0.5116279, 0.5116279, 0.2 * 0.99930 * 0.52))
        tab.page.mouse.click(x, y)
        time.sleep(2)
        get = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { selectedItems, itemDetails, itemsRefused } = await import(new URL("../model/selected-items.js", script));
  return [[...selectedItems.value], [...itemDetails.value], itemsRefused.value]; }"""
        print(tab.page.evaluate(get))
        tab.page.screenshot(path="/tmp/select/one.png")
        x0, y0 = self.place("cloud_intensity", "0", (-1.3, 0.9, 0))
        x1, y1 = self.place("cloud_intensity", "0", (-0.3, 0.0, 0))
        tab.page.mouse.move(x0, y0)
        tab.page.mouse.down()
        tab.page.mouse.move(x1, y1, steps=4)
        tab.page.screenshot(path="/tmp/select/drag.png")
        tab.page.mouse.up()
        time.sleep(3)
        got = tab.page.evaluate(get)
        print(len(got[0]), got[0][:3], got[0][-3:], got[2])
        tab.page.screenshot(path="/tmp/select/box.png")
