"""What a click takes while something is measured, in viser's own page."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.rviz.views import ORTHOGRAPHIC
from tests.support.robots import rover
from tests.support.scene_page import ScenePage
from tests.support.scene_server import SceneServer

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(180)]

_PLACE_OF = """([link, point]) => {
  const { camera, canvas, nodeRefFromName } = __viserMutable;
  const { matrixWorld } = nodeRefFromName[`/robot/${encodeURIComponent(link)}`];
  const seen = camera.position.clone().set(...point).applyMatrix4(matrixWorld).project(camera);
  return [((seen.x + 1) / 2) * canvas.clientWidth, ((1 - seen.y) / 2) * canvas.clientHeight];
}"""
_LISTEN = """() => studio3d.events.addEventListener("measure", (event) =>
  heard.push(["measure", event.detail.anchor]))"""
HALF_LENGTH_M, HALF_WIDTH_M = 0.31, 0.20
"""Of the hull's box in the frame of base_link."""


@pytest.fixture(scope="module")
def server() -> Iterator[SceneServer]:
    with SceneServer() as running:
        running.call(lambda scene: scene.show(rover(), None))
        yield running


@pytest.fixture(scope="module")
def opened(browser: Browser, server: SceneServer) -> Iterator[ScenePage]:
    context = browser.new_context()
    view = ScenePage(context.new_page(), server, rover()).open()
    view.run(_LISTEN)
    yield view
    context.close()


@pytest.fixture
def view(opened: ScenePage) -> Iterator[ScenePage]:
    opened.start_again()
    yield opened
    opened.run("studio3d.setMeasuring(null); studio3d.setTool('Interact')")


def taken(view: ScenePage, mode: str, link: str, point: tuple[float, float, float]) -> Any:  # noqa: ANN401
    """What a click where a point of a link is seen takes."""
    view.run("(mode) => { studio3d.setTool('Measure'); studio3d.setMeasuring(mode); }", mode)
    before = len(view.heard("measure"))
    x, y = view.run(_PLACE_OF, [link, point])
    view.page.mouse.click(x, y)
    view.until(f"heard.filter(([type]) => type === 'measure').length > {before}")
    return view.heard("measure")[-1]


def test_a_point_is_taken_where_it_is_on_the_surface_with_the_way_that_faces(view: ScenePage):
    wanted = (HALF_LENGTH_M, -0.06, 0.22)
    view.page.keyboard.down("Alt")
    found = taken(view, "points", "base_link", wanted)
    view.page.keyboard.up("Alt")
    assert (found["kind"], found["link"]) == ("point", "base_link")
    assert found["at"][0] == pytest.approx(HALF_LENGTH_M, abs=1e-6)
    assert math.dist(found["at"], wanted) < 0.01
    assert found["normal"] == pytest.approx([1, 0, 0], abs=1e-6)


def test_without_perspective_the_point_under_the_mouse_is_taken_too(view: ScenePage):
    wanted = (HALF_LENGTH_M, -0.06, 0.22)
    view.run("(name) => studio3d.setViewValue(name, true)", ORTHOGRAPHIC)
    view.pictures(2)
    view.page.keyboard.down("Alt")
    found = taken(view, "points", "base_link", wanted)
    view.page.keyboard.up("Alt")
    view.run("(name) => studio3d.setViewValue(name, false)", ORTHOGRAPHIC)
    assert found["at"][0] == pytest.approx(HALF_LENGTH_M, abs=1e-6)
    assert math.dist(found["at"], wanted) < 0.01


def test_near_a_corner_the_corner_itself_is_taken_but_not_with_alt_held(view: ScenePage):
    beside = (HALF_LENGTH_M, -HALF_WIDTH_M + 0.008, 0.168)
    corner = [HALF_LENGTH_M, -HALF_WIDTH_M, 0.16]
    assert taken(view, "points", "base_link", beside)["at"] == pytest.approx(corner, abs=1e-6)
    view.page.keyboard.down("Alt")
    found = taken(view, "points", "base_link", beside)
    view.page.keyboard.up("Alt")
    assert math.dist(found["at"], corner) > 0.003


def test_frames_and_axes_are_taken_through_what_hides_them(view: ScenePage):
    found = taken(view, "frames", "upper arm", (0, 0, 0))
    assert found == {"kind": "frame", "link": "upper arm"}
    found = taken(view, "axes", "upper arm", (0, 0.06, 0))
    assert found == {"kind": "axis", "link": "upper arm", "joint": "lift"}


def test_while_measuring_nothing_is_selected_dragged_or_focused(view: ScenePage):
    view.run("studio3d.setTool('Measure'); studio3d.setMeasuring('points')")
    x, y = view.place_of("upper%20arm/visual/0")
    view.page.mouse.dblclick(x, y)
    view.draw_mouse((x, y), (60, -30))
    view.page.mouse.up()
    view.until("heard.filter(([type]) => type === 'measure').length >= 2")
    for kind in ("select", "drag", "focus"):
        assert view.heard(kind) == []
    view.run("studio3d.setTool('Interact')")
    view.page.mouse.click(x, y)
    view.until("heard.some(([type]) => type === 'select')")


def test_a_measure_is_drawn_where_its_ends_are_seen_and_moves_with_them(view: ScenePage):
    measure = {
        "ends": [{"kind": "frame", "link": "base_link"}, {"kind": "frame", "link": "upper arm"}],
        "label": "0.5 m",
    }
    view.run("(one) => studio3d.setMeasures([one])", measure)
    drawn = "document.querySelector('.studio-lines polyline')?.getAttribute('points')"
    view.until(drawn)
    first = view.run(drawn)
    x, y = view.run(_PLACE_OF, ["base_link", (0, 0, 0)])
    began = [float(part) for part in first.split()[0].split(",")]
    assert math.dist(began, (x, y)) < 1
    assert view.run("document.querySelector('.studio-label').textContent") == "0.5 m"
    view.run("studio3d.view('top')")
    view.until(f"{drawn} !== '{first}'")
    view.run("studio3d.setMeasures([])")
    view.until("!document.querySelector('.studio-lines polyline')")
