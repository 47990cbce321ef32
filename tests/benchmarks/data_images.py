"""Images of a camera in Chromium: how many are shown in a second, and what one takes to paint.

A camera in a process of its own sends 1920 x 1080 in rgb8, 6.2 MB each, 30 in a second; the panel
shows them in a window of 1600 x 950. Painting is measured without a browser, in Node.
"""

from __future__ import annotations

import json
import re
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.benchmarks.report import judge, judge_that, say
from tests.support.bare_page import bare_page, processor_s
from tests.support.numbered_camera import numbered_camera
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from tests.support.bare_page import BarePage
    from tests.support.server import RunningStudio

SIZE: Final = (1920, 1080)
RATE_HZ: Final = 30.0
RUNS: Final = 3
SECONDS: Final = 5
_PAINT_MS: Final = 15.0
"""For a whole picture; less than half of the time that it has at 30 Hz."""
_SHOWN_SHARE: Final = 0.95
_FACTS: Final = "document.querySelector('.image-facts')?.innerText ?? ''"
_PAINTING: Final = Path(__file__).with_name("image_painting.mjs")


def run() -> None:
    """Painting first, for which nothing else needs to run."""
    _measure_painting()
    with running_router() as endpoint, tempfile.TemporaryDirectory() as scratch:
        words = ["demo", "--connect", endpoint, "--router", "off"]
        with (
            running_studio(words, Path(scratch) / "data") as studio,
            numbered_camera(endpoint, SIZE, RATE_HZ) as camera,
            bare_page(studio.url, 1600, 950) as page,
        ):
            _show(studio, page)
            processes = {"Chromium": page.pid, "studio": studio.pid, "camera": camera.process.pid}
            _measure_shown(page, processes)


def _measure_painting() -> None:
    node = shutil.which("node")
    if node is None:
        say("  there is no Node: painting is not measured")
        return
    told = subprocess.run([node, str(_PAINTING)], capture_output=True, text=True, check=True)
    say("  ms for a picture of 1920 x 1080, read from its message: all of it, and in 480 x 270")
    whole_ms: list[float] = []
    for encoding, (whole, small) in json.loads(told.stdout).items():
        say(f"    {encoding:<14}{whole:7.2f}{small:7.2f}")
        whole_ms.append(whole)
    judge("painting 1920 x 1080, the slowest encoding", max(whole_ms), at_most=_PAINT_MS)


def _show(studio: RunningStudio, page: BarePage) -> None:
    with studio.client() as client:
        client.post(
            "/api/commands", json={"type": "connect_wire"}, headers={"origin": studio.origin}
        ).raise_for_status()
    page.until("document.querySelector('.dv-tab')")
    wait_until("pictures", lambda: _are_pictures_shown(page))


def _are_pictures_shown(page: BarePage) -> bool:
    """The layout may still be on its way: the panel is brought to the front again and again."""
    page.evaluate(f"({SHOW_PANEL})('image')")
    return "Hz" in page.evaluate(_FACTS)


def _measure_shown(page: BarePage, processes: dict[str, int]) -> None:
    """As the panel counts what it painted: to ask for pixels would cost as much as they do."""
    rates: list[float] = []
    for _ in range(RUNS):
        began_s = time.perf_counter()
        cpu_s = {name: processor_s(pid) for name, pid in processes.items()}
        seen = [_rate_after_a_second(page) for _ in range(SECONDS)]
        took_s = time.perf_counter() - began_s
        rates.append(statistics.mean(seen))
        shares = (
            f"{name} {(processor_s(pid) - cpu_s[name]) / took_s:4.0%}"
            for name, pid in processes.items()
        )
        say(f"    {rates[-1]:5.1f} pictures in a second; of a core: {', '.join(shares)}")
    share = statistics.median(rates) / RATE_HZ
    judge_that("6.2 MB at 30 Hz are shown at 30 Hz in Chromium", holds=share >= _SHOWN_SHARE)


def _rate_after_a_second(page: BarePage) -> float:
    """Of the last thirty pictures."""
    time.sleep(1.0)
    found = re.search(r"([0-9.]+)\sHz", page.evaluate(_FACTS))
    return float(found[1]) if found else 0.0
