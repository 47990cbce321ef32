"""Every shape of a Drawing is seen where it is, in its colour, as see-through as it is to be."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
import pytest

from studio.displays.drawing import Arrows, Axes, Lines, Placed, Points, Solids
from tests.support.live_page import LivePage
from tests.support.live_shapes import (
    BLUE,
    MESH_URI,
    RED,
    UPRIGHT,
    at,
    drawing_of,
    every_shape,
    places,
    solids,
    upright,
)
from tests.support.scene_server import SceneServer
from tests.support.watched_scene import triangle

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser

    from studio.displays.drawing import Shape
    from studio.scene import DocumentScene

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

FROM_ABOVE: Final = ((2.5, -2.05, 8.0), (2.5, -2.0, 0.0))
"""A hair from the south, or it would not be clear which side is up."""
R, G, B, NOTHING, MAGENTA = "red", "green", "blue", "nothing", "magenta"
_PLAIN: Final = {R: (1, 0, 0), G: (0, 1, 0), B: (0, 0, 1), MAGENTA: (1, 0, 1)}
SEEN: Final[dict[str, list[tuple[float, float, str, float]]]] = {
    "squares": [(0, 0, G, 1), (0.28, 0.28, G, 1), (0.34, 0, NOTHING, 0), (0, -0.34, NOTHING, 0)],
    "faint": [(0, 0, R, 0.5), (0.28, -0.28, R, 0.5), (0.34, 0, NOTHING, 0)],
    "spheres": [(0, 0, R, 1), (0.27, 0, R, 1), (0.27, 0.27, NOTHING, 0)],
    "boxes": [(0, 0, G, 1), (0.28, 0.28, G, 1)],
    "pixels": [(0, 0, B, 1), (0.1, -0.1, B, 1), (0.4, 0, NOTHING, 0)],
    "tiles": [(0, 0, G, 1), (0.28, 0.28, G, 1), (0.34, 0, NOTHING, 0)],
    "wide": [(0.3, 0.03, G, 1), (-0.3, -0.03, G, 1), (0.3, 0.08, NOTHING, 0)],
    "faint-wide": [(0.3, 0.05, G, 0.5), (-0.3, -0.05, G, 0.5), (0, 0, G, 0.5)],
    "two": [(-0.38, 0, R, 1), (0.38, 0, B, 1), (0, 0, MAGENTA, 1)],
    "arrow": [(-0.3, 0, R, 1), (-0.3, 0.07, NOTHING, 0), (0.13, 0.06, R, 1), (0.44, 0, NOTHING, 0)],
    "faint-arrow": [(-0.3, 0.01, R, 0.4)],
    "short": [(0, 0, B, 1), (-0.07, 0.08, B, 1), (-0.16, 0, NOTHING, 0), (0.16, 0, NOTHING, 0)],
    "axes": [(0.3, 0, R, 1), (0, 0.3, G, 1)],
    "faint-axes": [(0.3, 0, R, 0.3), (0, 0.3, G, 0.3)],
    "box": [(0, 0, R, 1), (0.28, -0.28, R, 1)],
    "sphere": [(0, 0, G, 1), (0.27, 0.27, NOTHING, 0)],
    "cylinder": [(0, 0, B, 0.5), (0.3, 0.3, NOTHING, 0)],
    "cone": [(0, 0, R, 1)],
    "triangles": [(0.2, -0.2, G, 1), (-0.28, 0.28, G, 1), (0.34, 0, NOTHING, 0)],
    "coloured": [(0, -0.28, R, 1), (0, 0.28, B, 1), (0, 0, MAGENTA, 1)],
    "mesh": [(0.1, 0.1, MAGENTA, 1), (0.4, 0.4, NOTHING, 0)],
    "picture": [
        (-0.3, -0.3, G, 1),
        (-0.22, -0.3, G, 1),  # as green as in the middle: the pixels are not blended
        (-0.18, -0.3, R, 1),
        (-0.1, -0.1, B, 1),
        (0.3, 0.3, B, 1),
        (0.1, 0.3, R, 1),
    ],
    "behind": [(-0.3, -0.3, G, 1), (-0.18, -0.3, R, 1)],
    "frustum": [(0.1, -0.2, R, 1), (0.1, 0.12, B, 1)],
    "faint-frustum": [(0.3, -0.2, R, 0.4), (0.3, 0.1, B, 0.4)],
}
"""By shape: places from its origin in m, the colour there and how opaque it is."""


def shapes() -> dict[str, Shape]:
    return every_shape()


@pytest.fixture(scope="module")
def server() -> Iterator[SceneServer]:
    with SceneServer() as running:
        running.call(draw_all)
        yield running


def draw_all(scene: DocumentScene) -> None:
    """Every shape, and below both pictures a box."""
    drawing = drawing_of(shapes())
    deep = replace(solids("box", BLUE), positions=np.array([[0, 0, -0.35]], np.float32))
    shapes_behind = {**drawing["behind"].shapes, "deep": deep}
    drawing["behind"] = Placed("map", 0, shapes_behind)
    drawing["picture"] = Placed("map", 0, {**drawing["picture"].shapes, "deep": deep})
    scene.set_display("grid", "visible", value=False)
    scene.live.apply("all", drawing, places())
    scene.provide_mesh(MESH_URI, triangle())
    scene.flush()


@pytest.fixture(scope="module")
def view(browser: Browser, server: SceneServer) -> Iterator[LivePage]:
    """One page and one picture for all that is only looked at."""
    context = browser.new_context()
    view = LivePage(context.new_page(), server).open()
    view.until("__viserMutable.nodeRefFromName['/live/all/grid/grid.lines']")
    for name in ("picture/picture.0-0", "behind/behind.0-0", "words/words.text"):
        view.until(f"hasPicture('/live/all/{name}')")
    for name in ("frustum/frustum.frustum", "faint-frustum/faint-frustum.frustum"):
        view.until(f"hasPicture('/live/all/{name}')")
    view.look(*FROM_ABOVE)
    view.take()
    yield view
    context.close()


def looks(view: LivePage, name: str, x: float, y: float) -> tuple[str, float]:
    """The plain colour at a place of a shape and how opaque it is."""
    at_x, at_y, _ = places()[name][1]
    red, green, blue, alpha = view.rgba(at_x + x, at_y + y)
    if alpha < 20:
        return NOTHING, 0.0
    most = max(red, green, blue)
    lit = tuple(int(part > 0.5 * most) for part in (red, green, blue))
    named = next((colour for colour, parts in _PLAIN.items() if parts == lit), str(lit))
    return named, alpha / 255


@pytest.mark.parametrize("name", SEEN)
def test_a_shape_is_seen_where_it_is(view: LivePage, name: str):
    for x, y, colour, opacity in SEEN[name]:
        seen, alpha = looks(view, name, x, y)
        assert (x, y, seen) == (x, y, colour)
        assert alpha == pytest.approx(opacity, abs=0.06)


def test_hair_lines_and_grids_are_thin_and_there(view: LivePage):
    for name, x, y in (("hair", 0.2, 0.0), ("grid", 0.25, 0.2)):
        at_x, at_y, _ = places()[name][1]
        square = view.around(at_x + x, at_y + y, 3)
        assert square[..., 3].max() > 100
        assert (square[..., 3] > 100).any(axis=1).sum() <= 3


def test_words_are_in_their_colour_and_of_their_size_and_a_plate_is_white(view: LivePage):
    at_x, at_y, _ = places()["words"][1]
    square = view.around(at_x, at_y, 45).astype(int)
    orange = (square[..., 0] > 200) & (abs(square[..., 1] - 160) < 30) & (square[..., 2] < 60)
    rows = np.flatnonzero(orange.any(axis=1))
    pixel_m = 1 / abs(view.place(0, 0)[0] - view.place(1, 0)[0])
    assert 0.21 < (rows[-1] - rows[0] + 1) * pixel_m < 0.3
    at_x, at_y, _ = places()["screen-words"][1]
    cyan = view.around(at_x, at_y, 20).astype(int)
    assert ((cyan[..., 2] > 200) & (cyan[..., 0] < 90) & (cyan[..., 3] > 200)).any()
    at_x, at_y, _ = places()["plate"][1]
    plate = view.around(at_x, at_y + 0.1, 12)
    assert (plate[..., :3] > 230).all(axis=2).any()
    assert (plate[..., :3] < 60).all(axis=2).any()


def test_a_picture_behind_everything_hides_nothing_and_another_one_does(view: LivePage):
    assert looks(view, "behind", 0.05, -0.12)[0] == B  # red, if the box below were hidden
    assert looks(view, "picture", 0.05, -0.12)[0] == R


def test_words_face_the_eye_from_wherever_it_looks(view: LivePage):
    view.look((3, -8, 0.5), (3, -3, 0))
    view.take()
    at_x, at_y, _ = places()["words"][1]
    square = view.around(at_x, at_y, 40).astype(int)
    orange = (square[..., 0] > 200) & (abs(square[..., 1] - 160) < 30) & (square[..., 2] < 60)
    assert orange.sum() > 100


_COUNT_PROGRAMS: Final = """() => {
  window.programs = 0;
  const gl = __viserMutable.canvas.getContext("webgl2");
  const link = gl.linkProgram.bind(gl);
  gl.linkProgram = (program) => { window.programs += 1; link(program); };
}"""
_COUNT_OF: Final = """(name) => {
  let count = 0;
  __viserMutable.nodeRefFromName[name]?.traverse((object) => {
    if (object.isPoints) count = object.geometry.attributes.position.count;
  });
  return count;
}"""


def test_a_cloud_that_streams_makes_the_page_compile_nothing(view: LivePage):
    node = "/live/cloud/a/c.points"
    view.page.evaluate(_COUNT_PROGRAMS)
    for count in (100, 101, 102, 103):
        colors = np.zeros((count, 3), np.uint8)
        cloud = Points(np.zeros((count, 3), np.float32), colors, opacity=0.5)
        drawing = {"a": Placed("map", 0, {"c": cloud})}
        view.server.call(lambda scene, drawing=drawing: show_cloud(scene, drawing))
        view.until(f"({_COUNT_OF})('{node}') === {count}")
        view.take()
        if count == 100:
            view.page.evaluate("window.programs = 0")
    assert view.page.evaluate("programs") == 0
    view.server.call(lambda scene: (scene.live.drop("cloud"), scene.flush()))
    view.until(f"!__viserMutable.nodeRefFromName['{node}']")


def show_cloud(scene: DocumentScene, drawing: dict[str, Placed]) -> None:
    scene.live.apply("cloud", drawing, {"a": UPRIGHT})
    scene.flush()


def test_shapes_that_grow_and_shrink_are_all_there(view: LivePage):
    spots = np.array([[0, 0, 0], [0.6, 0, 0], [0, 0.6, 0]], np.float32)
    ahead = np.array([0.3, 0, 0], np.float32)

    def of(count: int) -> dict[str, Shape]:
        some, scales = spots[:count], np.full((count, 3), 0.2, np.float32)
        colors = np.tile(np.array([[255, 0, 0]], np.uint8), (count, 1))
        ends = np.stack([some, some + ahead], axis=1)
        return {
            "solids": Solids("sphere", some, upright(count), scales, colors),
            "axes": Axes(some, upright(count), 0.3, 0.05),
            "arrows": Arrows(ends, colors, 0.08, 0.16, 0.1),
            "lines": Lines(ends, np.stack([colors, colors], axis=1), 0.1),
        }

    spread = {"solids": at(0, 0), "axes": at(2, 0), "arrows": at(0, -2), "lines": at(2, -2)}
    view.server.call(lambda scene: (scene.live.drop("all"), scene.flush()))
    view.look(*FROM_ABOVE)
    for count in (1, 3, 2):
        drawing = drawing_of(of(count))
        view.server.call(
            lambda scene, drawing=drawing: (
                scene.live.apply("grown", drawing, spread),
                scene.flush(),
            )
        )
        told = "__viserSceneTree.getState()['/live/grown/solids/solids.many']?.message.props"
        view.until(f"{told}?.batched_positions.length === {3 * count}")
        view.until("__viserMutable.nodeRefFromName['/live/grown/lines/lines.lines']")
        view.take()
        for name, (_, (x, y, _)) in spread.items():
            shown = [view.rgba(x + dx + 0.08, y + dy)[3] > 200 for dx, dy, _ in spots.tolist()]
            assert (name, shown) == (name, [number < count for number in range(3)])
    view.server.call(lambda scene: (scene.live.drop("grown"), draw_all(scene)))
    view.until("__viserMutable.nodeRefFromName['/live/all/grid/grid.lines']")


@pytest.mark.parametrize(("size_m", "pixels"), [(0.01, 3), (0.6, 30)])
def test_a_point_of_a_scan_is_three_pixels_wide_at_least(
    view: LivePage, size_m: float, pixels: int
):
    at_x, at_y = 5.5, -4.0
    spot = {"a": Placed("map", 0, {"c": Points(np.zeros((1, 3), np.float32), RED, size_m)})}
    view.look(*FROM_ABOVE)
    view.server.call(
        lambda scene: (scene.live.apply("spot", spot, {"a": at(at_x, at_y)}), scene.flush())
    )
    view.until("__viserMutable.nodeRefFromName['/live/spot/a/c.points']")
    view.take()
    square = view.around(at_x, at_y, 40).astype(int)
    red = (square[..., 0] > 200) & (square[..., 1] < 60) & (square[..., 3] > 200)
    wide = int(red.any(axis=0).sum())
    assert wide == 3 if pixels == 3 else wide >= pixels
    view.server.call(lambda scene: (scene.live.drop("spot"), scene.flush()))
    view.until("!__viserMutable.nodeRefFromName['/live/spot/a/c.points']")


def test_what_was_see_through_becomes_opaque_again_and_a_cloud_may_grow(view: LivePage):
    faint = [name for name in shapes() if name.startswith("faint")]
    opaque = {name: replace(shapes()[name], opacity=1.0) for name in faint}  # pyright: ignore[reportCallIssue]
    grown = np.array([[0, 0, 0], [0, 0.5, 0], [0, -0.5, 0]], np.float32)
    drawing = drawing_of({**opaque, "squares": Points(grown, BLUE, 0.2, precise=True)})
    view.server.call(
        lambda scene: (scene.live.apply("all", drawing, places()), scene.flush()),
    )
    view.until("!__viserMutable.nodeRefFromName['/live/all/grid/grid.lines']")
    view.look(*FROM_ABOVE)
    view.take()
    for name in faint:
        x, y, colour, _ = SEEN[name][0]
        assert looks(view, name, x, y) == (colour, 1.0)
    assert [looks(view, "squares", 0, y)[0] for y in (-0.5, 0, 0.25, 0.5)] == [B, B, NOTHING, B]
    view.server.call(lambda scene: (scene.live.place("all", {"faint": None}), scene.flush()))
    view.until("!__viserMutable.nodeRefFromName['/live/all/faint'].visible")
    view.take()
    assert looks(view, "faint", 0, 0)[0] == NOTHING
    assert view.errors == []
