"""How long the largest things keep the loop: nobody else is served while they do.

Counted is the processor time of the loop's own thread in one go, so that what others take on the
machine is no part of it.
"""

from __future__ import annotations

import asyncio
import time
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.map import MapDisplay
from studio.displays.point_cloud2 import PointCloud2Display
from studio.displays.tf import TfDisplay
from studio.live.displays.scene_frames import SceneFrames
from studio.live.topics.zenoh_source import ZenohSource
from studio.protocol.displays import GetTf
from studio.robot.values import Joint, JointType, Link, Origin, Robot
from studio.scene import DocumentScene
from tests.benchmarks.displays import TYPES, cloud_message, map_message
from tests.benchmarks.report import Timings, judge, say_beside
from tests.support.live_shapes import UPRIGHT
from tests.support.posed import Posed
from tests.support.viser_frames import joined

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.displays.display import Display, Received
    from studio.displays.properties import Value

LINKS: Final = 10_000
_RUNS: Final = 5
_MAP_CELLS: Final = 4_000


class Stretches:
    """The longest that the loop's thread worked in one go; ask `longest_ms` now and then."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._last_s = time.thread_time()
        self._longest_s = 0.0
        self._ends = False
        self._loop.call_soon(self._look)

    def longest_ms(self) -> float:
        """Since this was asked last."""
        longest_s, self._longest_s = self._longest_s, 0.0
        return longest_s * 1000

    def end(self) -> None:
        """Look no more."""
        self._ends = True

    def _look(self) -> None:
        now_s = time.thread_time()
        self._longest_s = max(self._longest_s, now_s - self._last_s)
        self._last_s = now_s
        if not self._ends:
            self._loop.call_soon(self._look)


def run() -> None:
    """All of it."""
    asyncio.run(_all())


async def _all() -> None:
    stretches = Stretches()
    await _frames(stretches)
    map_kind = partial(MapDisplay, TYPES)
    message = map_message(_MAP_CELLS)
    await _shown(stretches, "a map of 4,000 x 4,000, all new", map_kind, message, at_most=60)
    for count, at_most in ((300_000, 25), (1_000_000, 70)):
        message = cloud_message(count, "intensity")
        values: dict[str, Value] = {"Points at most": count}
        kind = partial(PointCloud2Display, TYPES, values)
        await _shown(stretches, f"a cloud of {count:,}", kind, message, at_most=at_most)
    stretches.end()


async def _frames(stretches: Stretches) -> None:
    """The first step of a robot of many links, and what a panel of its frames asks."""
    first, asked = Timings("the first step"), Timings("their list is asked for, in a thread")
    robot = _robot(LINKS)
    for _ in range(_RUNS):
        scene = DocumentScene(asyncio.get_running_loop())
        frames, display = SceneFrames(Posed(robot), ZenohSource()), TfDisplay(TYPES)
        await _settled(stretches)
        _step(scene, frames, display)
        first.values_ms.append(await _settled(stretches))
        await asyncio.to_thread(frames.answer, GetTf(), frames.fixed)
        asked.values_ms.append(await _settled(stretches))
        scene.close()
    say_beside(f"TF of {LINKS:,} links", first, asked)
    judge(f"loop: the first step of {LINKS:,} links", first.median_ms, at_most=250)
    judge(f"loop: {LINKS:,} frames are asked for", asked.median_ms, at_most=5)


def _step(scene: DocumentScene, frames: SceneFrames, display: TfDisplay) -> None:
    frames.step()
    display.see(frames.now())
    drawing = display.draw(0)
    scene.live.apply("1", drawing, dict.fromkeys(drawing, UPRIGHT))
    scene.flush()


async def _shown(
    stretches: Stretches,
    title: str,
    make: Callable[[], Display],
    message: Received,
    *,
    at_most: float,
) -> None:
    """A message that nothing is known of yet, in ticks until all of it is drawn."""
    longest = Timings(title)
    for _ in range(_RUNS):
        scene, display = DocumentScene(asyncio.get_running_loop()), make()
        peer, _ = await joined(scene)
        await _settled(stretches)
        display.take(message)
        drawing = display.draw(0)
        scene.live.apply("1", drawing, dict.fromkeys(drawing, UPRIGHT))
        scene.flush()
        while peer.frames:
            peer.frames.clear()
            await asyncio.sleep(0)
            scene.live.draw_waiting()
            scene.flush()
        longest.values_ms.append(await _settled(stretches))
        peer.leave()
        scene.close()
    say_beside("the longest that the loop is kept", longest)
    judge(f"loop: {title}", longest.median_ms, at_most=at_most)


async def _settled(stretches: Stretches) -> float:
    """Let the loop look, and give what was longest until now."""
    await asyncio.sleep(0.01)
    return stretches.longest_ms()


def _robot(links: int) -> Robot:
    """Links of which each hangs on one of the forty before it."""
    rng = np.random.default_rng(1)
    joints = [
        Joint(
            f"j{number}",
            JointType.FIXED,
            f"l{max(0, number - int(rng.integers(1, 40)))}",
            f"l{number}",
            Origin((0.01 * number, 0.0, 0.1)),
        )
        for number in range(1, links)
    ]
    names = [f"l{number}" for number in range(links)]
    return Robot(
        "many", {name: Link(name) for name in names}, {joint.name: joint for joint in joints}
    )
