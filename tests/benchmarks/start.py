"""From starting the command to the first drawn frame in a real browser, by its parts."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from tests.benchmarks.report import Timings, say_beside
from tests.support.browser import open_browser
from tests.support.server import running_studio

RUNS = 3
_DRAWN = """() => {
  const view = window.__viserMutable;
  const names = Object.keys(view?.nodeRefFromName ?? {});
  return names.some((name) => name.includes("/visual/"))
    && (window.__viserTestpoints?.rendererInfo?.render?.frame ?? 1) > 0;
}"""


def run() -> None:
    """Start the demo, open viser's page alone, wait for the robot."""
    drawn = Timings("process start to first drawn frame")
    printed = Timings("process start to the printed address")
    for browser in open_browser():
        for _ in range(RUNS):
            with tempfile.TemporaryDirectory() as scratch:
                begin_s = time.perf_counter()
                with running_studio(["demo"], Path(scratch) / "data") as studio:
                    printed.values_ms.append((time.perf_counter() - begin_s) * 1000)
                    context = browser.new_context(viewport={"width": 480, "height": 360})
                    page = context.new_page()
                    page.goto(studio.url)
                    page.goto(f"{studio.origin}/d/rover/viser/?fixedDpr=1")
                    page.wait_for_function(_DRAWN)
                    drawn.values_ms.append((time.perf_counter() - begin_s) * 1000)
                    context.close()
    say_beside("the demo rover, Chromium warm, software GL", drawn, printed)
