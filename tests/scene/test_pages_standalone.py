"""The 3D view as a page of its own: it opens from the disk, asks nobody, and shows the robot."""

from __future__ import annotations

import io
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from studio.robot.values import Box, Cylinder, Link, Origin, Visual
from studio.scene.link_nodes import MeshShelf
from studio.scene.robot_drawing import Ground
from tests.support.studio_page import ACTION_PATIENCE_MS, wait_until
from tests.support.watched_scene import watched

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser

    from studio.scene import DocumentScene
    from tests.support.viser_frames import Peer

_DRAWN = """() => Object.keys(window.__viserMutable?.nodeRefFromName ?? {})
  .some((name) => name.includes("/visual/"))"""


def page_of_rover(*, dark: bool) -> bytes:
    pages: list[bytes] = []

    async def scenario(scene: DocumentScene, _: Peer) -> None:
        pages.append(scene.standalone_page('<script>"rover"', dark=dark)())

    watched(scenario)
    return pages[0]


def colours_of(picture: bytes) -> int:
    """How many colours a PNG has: an empty view has few."""
    with Image.open(io.BytesIO(picture)) as image:
        return len(image.convert("RGB").getcolors(1 << 24) or ())


def test_its_name_is_a_text_and_nothing_may_be_fetched():
    page = page_of_rover(dark=True).decode()
    assert "<title>&lt;script&gt;&quot;rover&quot;</title>" in page
    assert page.index("default-src 'none'") < page.index("<script")


def test_a_page_that_is_made_leaves_the_view_as_it_was():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        make = scene.standalone_page("rover", dark=True)
        scene.set_display("grid", "visible", value=False)
        assert len(make()) > 10_000
        scene.flush()
        assert peer.frames

    watched(scenario)


def test_the_bounds_are_those_of_the_turned_and_moved_boxes():
    ground = Ground()
    box = Visual(geometry=Box((2.0, 4.0, 6.0)), origin=Origin((1.0, 0.0, 0.0)))
    rod = Visual(geometry=Cylinder(0.5, 2.0), origin=Origin((0.0, 0.0, 9.0)))
    ground.note(Link("a", visuals=(box,)), MeshShelf())
    ground.note(Link("b", visuals=(rod,)), MeshShelf())
    quarter = np.sqrt(0.5)
    poses = np.array([[quarter, 0, 0, quarter, 0, 0, 10], [1, 0, 0, 0, 5, 0, 0]])
    low, high = ground.bounds_m(("a", "b"), poses)
    np.testing.assert_allclose(low, (-2, -0.5, 7), atol=1e-9)
    np.testing.assert_allclose(high, (5.5, 2, 13), atol=1e-9)
    low, high = Ground().bounds_m((), np.empty((0, 7)))
    assert (low.tolist(), high.tolist()) == ([0, 0, 0], [0, 0, 0])


@pytest.mark.browser
def test_it_opens_from_the_disk_and_turns_under_the_mouse(browser: Browser, tmp_path: Path):
    file = tmp_path / "rover.html"
    with ThreadPoolExecutor(1) as thread:  # this one has the loop that speaks with the browser
        file.write_bytes(thread.submit(page_of_rover, dark=False).result())
    context = browser.new_context(viewport={"width": 320, "height": 240}, offline=True)
    page = context.new_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(file.as_uri())
    page.wait_for_function(_DRAWN, timeout=ACTION_PATIENCE_MS)
    canvas = page.locator("canvas[data-engine]")
    wait_until("its pixels", lambda: colours_of(canvas.screenshot()) > 100)
    before = canvas.screenshot()
    page.mouse.move(160, 120)
    page.mouse.down()
    page.mouse.move(260, 120, steps=2)
    page.mouse.up()
    wait_until("the robot to turn", lambda: canvas.screenshot() != before)
    assert {url.partition(":")[0] for url in asked} <= {"file", "blob", "data"}
    context.close()
