"""From an edit on the control lane to changed pixels in a real browser.

viser's page alone, 480x360, one pixel ratio, no shadow: software GL draws slowly, and its floor is
in every figure. A probe in the page reads the middle of the picture whenever a frame was drawn and
notes when its colour changed; page and server share the clock of this machine.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.edit_to_websocket import Lane
from tests.benchmarks.report import Timings, judge, say_beside
from tests.support.browser import open_browser
from tests.support.server import RunningStudio, running_studio

if TYPE_CHECKING:
    from playwright.sync_api import Page

EDITS = 16
_JOINT = "arm_turret_joint"
_WARM_S = 4.0
_PROBE = """() => {
  const view = window.__viserMutable;
  const gl = view.canvas.getContext("webgl2");
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint8Array(4 * width * height);
  const look = () => {
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let sum = 0;
    for (let i = 0; i < pixels.length; i += 16) sum = (sum * 31 + pixels[i]) | 0;
    return sum;
  };
  window.changes = [];
  let last = look();
  let drawn = -1;
  const step = () => {
    const frame = window.__viserTestpoints?.rendererInfo?.render?.frame ?? drawn + 1;
    if (frame !== drawn) {
      drawn = frame;
      const now = look();
      if (now !== last) window.changes.push(performance.timeOrigin + performance.now());
      last = now;
    }
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}"""


def run() -> None:
    """Measure a part that moves and a primitive that changes its size."""
    moves, resizes = Timings("a joint moves"), Timings("wheel_radius: parts resize and move")
    with tempfile.TemporaryDirectory() as scratch:
        for browser in open_browser():
            with running_studio(["demo"], Path(scratch) / "data") as studio:
                context = browser.new_context(viewport={"width": 480, "height": 360})
                page = context.new_page()
                page.goto(studio.url)
                page.goto(f"{studio.origin}/d/rover/viser/?fixedDpr=1")
                _measure(studio, page, moves, resizes)
                context.close()
    say_beside("edit to pixels, the rover", moves, resizes)
    judge("edit to pixels p50, a part moves", moves.median_ms, at_most=40)
    judge("edit to pixels p50, a primitive changes", resizes.median_ms, at_most=60)


def _measure(studio: RunningStudio, page: Page, moves: Timings, resizes: Timings) -> None:
    lane = Lane(studio)
    lane.send("set_display", display="grid", name="shadow", value=False)
    lane.drain()
    time.sleep(_WARM_S)  # the first frames of software GL are slower than all others
    page.evaluate(_PROBE)
    site = lane.moving_site("wheel_radius")
    for number in range(EDITS):
        _until_changed(page, moves, lane, {"positions": {_JOINT: 0.1 * (number + 1)}})
        text = f"{0.08 + 0.004 * number:.3f}"
        _until_changed(page, resizes, lane, {"site": site["id"], "text": text})
    lane.close()


def _until_changed(page: Page, timings: Timings, lane: Lane, fields: dict[str, object]) -> None:
    """Send one command when the picture is still, and note when its first change was drawn."""
    page.wait_for_timeout(300)
    page.evaluate("() => { window.changes.length = 0; }")
    begin_ms = time.time_ns() / 1e6
    lane.send("set_joints" if "positions" in fields else "edit_site", **fields)
    page.wait_for_function("() => window.changes.length > 0", polling=30)
    timings.values_ms.append(page.evaluate("() => window.changes[0]") - begin_ms)
