"""What displays draw on its way to the page: links at 60 Hz, clouds and markers at 10 Hz.

The server's cost is that of this process: the scene, viser's engine and one encoding for all. How
much of it arrives is counted in a Chromium that nobody listens in on, which draws with software GL
and shares the machine. Each stream is hidden first, then shown: what is lost of the hidden one was
lost on its way, and not to drawing.
"""

from __future__ import annotations

import asyncio
import logging
import time
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.drawing import Placed, Points, Shape, Solids
from studio.scene import DocumentScene
from tests.benchmarks.report import Timings, judge, judge_that, say, say_beside
from tests.support.bare_page import bare_page, processor_s
from tests.support.live_shapes import UPRIGHT, upright
from tests.support.scene_server import SceneServer
from tests.support.viser_frames import Peer, joined

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.scene.live_scene import Pose

LINKS: Final = 60
TICKS: Final = 600
_WINDOW: Final = (720, 600)
_AT_REST_S: Final = 3.0
_COUNTS: Final = """(() => {
  window.arrived = 0;
  const { messageQueue } = __viserMutable;
  const push = messageQueue.push;
  messageQueue.push = function (...messages) {
    for (const one of messages) if (one.name === "%s") window.arrived += 1;
    return push.apply(this, messages);
  };
})()"""
_PICTURES: Final = "__viserTestpoints.rendererInfo.render.frame"


def run() -> None:
    """All of it."""
    # A browser opens connections that it then does not need.
    logging.getLogger("websockets").setLevel(logging.CRITICAL)
    asyncio.run(_links())
    for visible in (False, True):
        _streams("300k points", 10, 60, lambda n: _cloud(300_000, n), visible=visible)
        _streams("1M points", 5, 20, lambda n: _cloud(1_000_000, n), visible=visible)
    _streams("2,000 markers", 10, 60, _markers, visible=True)


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
    name: str, rate_hz: float, count: int, shape_of: Callable[[int], Shape], *, visible: bool
) -> None:
    """Show another one so many times, and count what arrives."""
    shapes = [shape_of(number) for number in range(4)]
    title = f"{name} at {rate_hz:g} Hz, {'shown' if visible else 'hidden'}"
    costs = Timings(f"{title}: CPU of the server for each")
    with SceneServer() as server:
        _show(server, shapes[0])
        with bare_page(f"{server.url}?fixedDpr=1", *_WINDOW) as page:
            node = f"/live/7/a/s.{'many' if name.endswith('markers') else 'points'}"
            page.until(f"window.__viserMutable?.nodeRefFromName['{node}']")
            page.evaluate(_COUNTS % node)
            server.call(lambda scene: (scene.live.show("7", visible=visible), scene.flush()))
            time.sleep(_AT_REST_S)
            before = processor_s(page.pid), page.evaluate(_PICTURES), time.perf_counter()
            late_s = _send(server, shapes, costs, rate_hz, count)
            taken_s = time.perf_counter() - before[2]
            cores = (processor_s(page.pid) - before[0]) / taken_s
            pictures = (page.evaluate(_PICTURES) - before[1]) / taken_s
            time.sleep(_AT_REST_S)
            arrived = int(page.evaluate("arrived"))
    say_beside(title, costs)
    say(f"  {arrived} of {count} arrived; the last was sent {late_s:.2f} s late")
    say(f"  the browser drew {pictures:.1f} pictures a second and kept {cores:.1f} cores busy")
    judge_that(f"{title}: all reach Chromium", holds=arrived == count)


def _send(
    server: SceneServer, shapes: list[Shape], costs: Timings, rate_hz: float, count: int
) -> float:
    """Show one after the other; answers by how much the last was late, s."""
    next_s = time.perf_counter()
    for number in range(1, count + 1):
        begin_s = time.process_time()
        _show(server, shapes[number % len(shapes)])
        costs.values_ms.append((time.process_time() - begin_s) * 1000)
        next_s += 1 / rate_hz
        time.sleep(max(0.0, next_s - time.perf_counter()))
    return max(time.perf_counter() - next_s, 0.0)


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
