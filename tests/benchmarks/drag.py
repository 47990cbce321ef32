"""A slider dragged at 60 Hz: memory after the first seconds, and the value that is seen at last.

The studio's own page is open in a browser, as a person has it. STUDIO_DRAG_S is the duration.
"""

# playwright's CDP answers are plain dicts.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false, reportUnknownArgumentType=false
from __future__ import annotations

import os
import tempfile
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.benchmarks.edit_to_websocket import Lane, Site
from tests.benchmarks.report import judge, judge_that, say
from tests.support.browser import open_browser
from tests.support.server import RunningStudio, running_studio
from tests.support.viser_frames import messages_of

if TYPE_CHECKING:
    from playwright.sync_api import CDPSession, Page

DURATION_S = float(os.environ.get("STUDIO_DRAG_S", "60"))
SETTLED_AFTER = 1 / 6
"""Of the duration: memory may grow until then."""
RATE_HZ = 60
_GROWTH_MB = 4.0
"""What an allocator takes and gives back from one moment to the next."""
_RADII = """() => {
  const nodes = window.frames[0].__viserSceneTree?.getState() ?? {};
  return Object.fromEntries(
    Object.entries(nodes)
      .filter(([name, node]) => name.startsWith("/robot/") && node?.message?.props?.radius)
      .map(([name, node]) => [name, node.message.props.radius]));
}"""


def run() -> None:
    """Drag the rover's wheel radius."""
    with tempfile.TemporaryDirectory() as scratch:
        for browser in open_browser():
            with running_studio(["demo"], Path(scratch) / "data") as studio:
                context = browser.new_context(viewport={"width": 900, "height": 600})
                page = context.new_page()
                page.goto(studio.url)
                _measure(studio, page, context.new_cdp_session(page))
                context.close()


def _measure(studio: RunningStudio, page: Page, session: CDPSession) -> None:
    lane = Lane(studio)
    site = lane.moving_site("wheel_radius")
    hand = Hand(lane, site)
    hand.drag(DURATION_S * SETTLED_AFTER)
    before = _memory_mb(studio, session)
    hand.drag(DURATION_S * (1 - SETTLED_AFTER))
    after = _memory_mb(studio, session)
    lane.drain()
    say(f"{hand.count} edits in {DURATION_S:g} s, one gesture")
    for name, began_mb in before.items():
        say(f"  {name:<20}{began_mb:9.1f} MB  ->{after[name]:9.1f} MB")
        judge(f"drag: growth of the {name}", after[name] - began_mb, at_most=_GROWTH_MB, unit="MB")
    judge_that(
        "drag: the last value is the site's", holds=lane.sites[site["id"]]["text"] == hand.text
    )
    page.wait_for_timeout(1000)
    told, seen = _told_radii(studio, lane), page.evaluate(_RADII)
    judge_that("drag: the page shows the last value", holds=bool(told) and told == seen)
    lane.close()


class Hand:
    """Sends edits of one gesture at an even rate, while somebody reads what comes of them."""

    def __init__(self, lane: Lane, site: Site) -> None:
        self._lane, self._site = lane, site
        self.count, self.text = 0, ""

    def drag(self, duration_s: float) -> None:
        """Turn to and fro."""
        done = threading.Event()
        readers = [
            threading.Thread(target=self._lane.read_until, args=(one, done))
            for one in (self._lane.control, self._lane.scene)
        ]
        for reader in readers:
            reader.start()
        next_s = end_s = time.perf_counter()
        end_s += duration_s
        while next_s < end_s:
            self._edit()
            next_s += 1 / RATE_HZ
            time.sleep(max(0.0, next_s - time.perf_counter()))
        done.set()
        for reader in readers:
            reader.join()

    def _edit(self) -> None:
        self.count += 1
        part = abs(self.count % 200 - 100) / 100
        self.text = f"{self._site['number'] * (0.9 + 0.2 * part):.5f}"
        self._lane.send("edit_site", site=self._site["id"], text=self.text, gesture="drag")


def _memory_mb(studio: RunningStudio, session: CDPSession) -> dict[str, float]:
    """Of the studio, all its workers, and the page's JavaScript after a collection."""
    session.send("HeapProfiler.collectGarbage")
    heap: dict[str, Any] = session.send("Runtime.getHeapUsage")
    return {
        "studio": _resident_mb(studio.pid),
        "workers": sum(map(_resident_mb, studio.children())),
        "page's heap": heap["usedSize"] / 2**20,
    }


def _resident_mb(pid: int) -> float:
    status = Path(f"/proc/{pid}/status").read_text()
    (line,) = (one for one in status.splitlines() if one.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


def _told_radii(studio: RunningStudio, lane: Lane) -> dict[str, float]:
    """What a newcomer is told of everything that has a radius."""
    told: dict[str, float] = {}
    newcomer = studio.websocket(f"/d/{lane.document}/viser", "viser-v1.1.1")
    frame = newcomer.recv(timeout=10)
    assert isinstance(frame, bytes)
    for message in messages_of(frame):
        props = message.get("props") or message.get("updates") or {}
        if str(message.get("name", "")).startswith("/robot/") and props.get("radius"):
            told[message["name"]] = props["radius"]
    newcomer.close()
    return told
