"""At a rover that turns, what it sees stands where it is: shapes and poses come together."""

from __future__ import annotations

import math
import random
import time
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pytest

from studio.displays.drawing import Lines, Placed, Points, Solids
from tests.support.live_page import LivePage
from tests.support.live_shapes import RED, UPRIGHT, upright
from tests.support.scene_server import SceneServer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from playwright.sync_api import Browser

    from studio.displays.drawing import Drawing, Shape
    from studio.scene import DocumentScene

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

WALL: Final = (2.0, 0.5, 0.0)
"""What is seen, in the fixed frame, m."""
STEP_RAD: Final = 0.1
"""How far the rover turns from one sample to the next."""
SAMPLES: Final = 60
NEAR_M: Final = 0.01
_WATCH: Final = """() => {
  const firstOf = ({ isPoints, instanceMatrix, geometry }) => {
    const { position, instanceStart } = geometry?.attributes ?? {};
    if (instanceMatrix) return [...instanceMatrix.array.subarray(12, 15)];
    const rows = instanceStart ?? (isPoints ? position : undefined);
    return rows && [rows.getX(0), rows.getY(0), rows.getZ(0)];
  };
  const lookInto = (found) => {
    const live = __viserMutable.nodeRefFromName["/live"];
    live.updateWorldMatrix(true, true);
    const back = live.matrixWorld.clone().invert();
    for (const [name, node] of Object.entries(__viserMutable.nodeRefFromName)) {
      if (!/^\\/live\\/turning\\/[^/]+\\//.test(name)) continue;
      let place;
      node?.traverse((object) => {
        const first = place ? undefined : firstOf(object);
        if (first) place = object.position.clone().set(...first).applyMatrix4(object.matrixWorld);
      });
      if (place) (found[name] ??= []).push(place.applyMatrix4(back).toArray());
    }
  };
  window.looks = {};
  window.pictures = {};
  setInterval(() => lookInto(window.looks), 3);
  const { scene } = __viserMutable;
  const before = scene.onAfterRender;
  scene.onAfterRender = (...given) => {
    before(...given);
    lookInto(window.pictures);
  };
}"""


@pytest.fixture(scope="module")
def server() -> Iterator[SceneServer]:
    with SceneServer() as running:
        running.call(sample_of(0))
        yield running


@pytest.fixture(scope="module")
def seen(browser: Browser, server: SceneServer) -> Iterator[dict[str, dict[str, Any]]]:
    """Where each shape was, at any time and in each picture, while the rover turned."""
    context = browser.new_context()
    view = LivePage(context.new_page(), server).open()
    for node in ("points/seen.points", "lines/seen.lines", "solids/seen.many"):
        view.until(f"__viserMutable.nodeRefFromName['/live/turning/{node}']")
    view.page.evaluate(_WATCH)
    pause_s = random.Random(1)
    for number in range(1, SAMPLES):
        server.call(sample_of(number))
        time.sleep(pause_s.uniform(0, 0.1))  # not in step with the pictures
    view.until(f"Object.values(pictures)[0]?.length > {SAMPLES // 10}")
    yield view.page.evaluate("({ looks, pictures })")
    assert view.errors == []
    context.close()


def sample_of(number: int) -> Callable[[DocumentScene], None]:
    """Show what was seen from the rover at a time, and where it stood then."""
    turn_rad = number * STEP_RAD
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    x, y, z = WALL
    first = (cosine * x + sine * y, cosine * y - sine * x, z)
    count = 100 + number % 3
    rows = np.tile(np.array(first, np.float32), (count, 1))
    some = rows[:20]
    shapes: dict[str, Shape] = {
        "points": Points(rows, np.tile(RED, (count, 1)), 0.05, precise=True),
        "lines": Lines(np.stack([some, some + np.float32(0.1)], axis=1), RED, 0.05),
        "solids": Solids("sphere", some, upright(20), np.full((20, 3), 0.1, np.float32), RED),
    }
    drawing: Drawing = {name: Placed("rover", 0, {"seen": one}) for name, one in shapes.items()}
    wxyz = (math.cos(turn_rad / 2), 0.0, 0.0, math.sin(turn_rad / 2))

    def show(scene: DocumentScene) -> None:
        scene.live.apply("turning", drawing, dict.fromkeys(drawing, (wxyz, UPRIGHT[1])))
        scene.flush()

    return show


@pytest.mark.parametrize("when", ["looks", "pictures"])
def test_points_are_never_at_the_pose_of_another_sample(seen: dict[str, dict[str, Any]], when: str):
    assert len(seen[when]) == 3
    for name, places in seen[when].items():
        off_m = np.linalg.norm(np.array(places) - WALL, axis=1)
        assert len(off_m) > SAMPLES // 10
        assert (name, int((off_m > NEAR_M).sum())) == (name, 0)
