"""What displays draw on its way to the page: links at 60 Hz, clouds and markers at 10 Hz.

The server's cost is that of this process: the scene, viser's engine and one encoding for all. How
much of it arrives is counted in Chromium, which draws with software GL and shares the machine.
"""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.drawing import Placed, Points, Shape, Solids
from studio.scene import DocumentScene
from tests.benchmarks.report import Timings, judge, judge_that, say, say_beside
from tests.support.browser import open_browser
from tests.support.live_page import LivePage
from tests.support.live_shapes import UPRIGHT, upright
from tests.support.scene_server import SceneServer
from tests.support.viser_frames import Peer, joined

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Browser

    from studio.scene.live_display import Pose

LINKS: Final = 60
TICKS: Final = 600
_COUNTS: Final = """(name) => {
  window.arrived = 0;
  const { messageQueue } = __viserMutable;
  const push = messageQueue.push;
  messageQueue.push = function (...messages) {
    for (const one of messages) if (one.name === name) window.arrived += 1;
    return push.apply(this, messages);
  };
}"""


def run() -> None:
    """All of it."""
    asyncio.run(_links())
    for browser in open_browser():
        _streams(browser, "300k points", 10, 60, lambda n: _cloud(300_000, n))
        _streams(browser, "1M points", 5, 20, lambda n: _cloud(1_000_000, n))
        _streams(browser, "2,000 markers", 10, 60, _markers)


async def _links() -> None:
    """Poses of links for one viewer, and the same by viser's handles in an atomic block."""
    ours, setters = Timings("poses of 60 links placed"), Timings("viser's handle setters, atomic")
    scene = DocumentScene(asyncio.get_running_loop())
    shape = Points(np.zeros((1, 3), np.float32), np.zeros(3, np.uint8))
    drawing = {f"link_{n}": Placed("f", 0, {"p": shape}) for n in range(LINKS)}
    scene.live.apply("robot", drawing, dict.fromkeys(drawing, UPRIGHT))
    handles = [scene.viser.scene.add_frame(f"/stock/{n}") for n in range(LINKS)]
    scene.flush()
    peer, _ = await joined(scene)
    for tick in range(TICKS):
        poses = {name: _pose(tick, n) for n, name in enumerate(drawing)}
        _timed(ours, peer, lambda poses=poses: _place(scene, poses))

        def set_all(tick: int = tick) -> None:
            with scene.viser.atomic():
                for number, handle in enumerate(handles):
                    handle.wxyz, handle.position = _pose(tick, number)
            scene.flush()

        _timed(setters, peer, set_all)
    scene.close()
    await asyncio.sleep(0)
    say_beside(f"CPU of one tick of {LINKS} links, one viewer", ours, setters)
    share = ours.median_ms / setters.median_ms
    judge("60 links: CPU against viser's setters", share, at_most=0.5, unit="of it")


def _place(scene: DocumentScene, poses: dict[str, Pose]) -> None:
    scene.live.place("robot", poses)
    scene.flush()


def _pose(tick: int, number: int) -> Pose:
    angle = 0.01 * tick + number
    cos, sin = float(np.cos(angle)), float(np.sin(angle))
    return (cos, 0.0, 0.0, sin), (cos, sin, 0.1 * number)


def _timed(timings: Timings, peer: Peer, do: Callable[[], None]) -> None:
    begin_s = time.process_time()
    do()
    timings.values_ms.append((time.process_time() - begin_s) * 1000)
    peer.frames.clear()


def _streams(
    browser: Browser, name: str, rate_hz: float, count: int, shape_of: Callable[[int], Shape]
) -> None:
    """Show another one so many times, and count what arrives."""
    shapes = [shape_of(number) for number in range(4)]
    costs = Timings(f"{name}: CPU of the server for each")
    context = browser.new_context()
    with SceneServer() as server:
        _show(server, shapes[0])
        view = LivePage(context.new_page(), server).open()
        (part,) = ("many",) if name.endswith("markers") else ("points",)
        view.until(f"__viserMutable.nodeRefFromName['/live/7/a/s.{part}']")
        view.page.evaluate(_COUNTS, f"/live/7/a/s.{part}")
        next_s = time.perf_counter()
        for number in range(1, count + 1):
            begin_s = time.process_time()
            _show(server, shapes[number % 4])
            costs.values_ms.append((time.process_time() - begin_s) * 1000)
            next_s += 1 / rate_hz
            time.sleep(max(0.0, next_s - time.perf_counter()))
        late_s = time.perf_counter() - next_s
        view.page.wait_for_timeout(3000)
        arrived = int(view.page.evaluate("arrived"))
    context.close()
    say_beside(f"{name} at {rate_hz:g} Hz", costs)
    say(f"  {arrived} of {count} arrived; the last was sent {max(late_s, 0):.2f} s late")
    judge_that(f"{name} at {rate_hz:g} Hz: all reach Chromium", holds=arrived == count)


def _show(server: SceneServer, shape: Shape) -> None:
    drawing = {"a": Placed("f", 0, {"s": shape})}
    server.call(lambda scene: (scene.live.apply("7", drawing, {"a": UPRIGHT}), scene.flush()))


def _cloud(count: int, seed: int) -> Points:
    rng = np.random.default_rng(seed)
    positions = rng.uniform(-5, 5, (count, 3)).astype(np.float32)
    return Points(positions, rng.integers(0, 256, (count, 3), np.uint8), 0.02)


def _markers(seed: int) -> Solids:
    rng = np.random.default_rng(seed)
    count = 2000
    return Solids(
        "box",
        rng.uniform(-5, 5, (count, 3)).astype(np.float32),
        upright(count),
        np.full((count, 3), 0.1, np.float32),
        rng.integers(0, 256, (count, 3), np.uint8),
    )
