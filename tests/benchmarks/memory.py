"""The memory of the studio and of its page while the demo rover drives and every display is on."""

from __future__ import annotations

import statistics
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from studio.displays.catalogue import DISPLAYS
from tests.benchmarks.memory_topics import told_topics
from tests.benchmarks.report import judge, judge_that, say
from tests.support.browser import open_browser
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Generator

    from playwright.sync_api import Browser, CDPSession

    from tests.support.server import RunningStudio

_EVERY_S: Final = 10.0
_WARM_UP: Final = 6
"""Samples: what is kept for so many seconds fills up, and the heaps find their size."""
_MB: Final = 1e6
_NODES: Final = """() => {
  const view = document.querySelector("iframe").contentWindow;
  return Object.keys(view.__viserMutable.nodeRefFromName).length;
}"""


@dataclass(frozen=True)
class Sample:
    """Megabytes at one time, and how many nodes the 3D view has."""

    server: float
    workers: float
    page: float
    gpu: float
    heap: float
    nodes: int


def run(minutes: float = 1.0) -> None:
    """All of it, with one page that looks on for so long."""
    samples: list[Sample] = []
    errors = ""
    with (
        tempfile.TemporaryDirectory() as scratch,
        router_at(free_endpoint()) as router,
        told_topics(router.endpoint.text) as topics,
        running_studio(
            ["demo", "--connect", router.endpoint.text, "--router", "off"],
            Path(scratch) / "data",
            moving=True,
        ) as studio,
    ):
        for browser in open_browser():
            samples += _samples(browser, studio, topics, minutes)
            errors = "\n".join(one for one in studio.stderr.splitlines() if "[INFO]" not in one)
    if errors:
        say(f"  the studio said: {errors[-500:]}")
    judge_that("memory: the studio had nothing to complain of", holds=not errors)
    _judge(samples[_WARM_UP:])


def _samples(
    browser: Browser, studio: RunningStudio, topics: dict[str, str], minutes: float
) -> Generator[Sample]:
    context = studio_context(browser)
    page = StudioPage(context.new_page())
    page.open(studio.url)
    _add_displays(studio, topics)
    of_page = context.new_cdp_session(page.page)
    of_browser = browser.new_browser_cdp_session()
    say(f"{'s':>6}{'server':>9}{'workers':>9}{'page':>9}{'GPU':>9}{'heap':>9}{'nodes':>7}   (MB)")
    begin_s = time.monotonic()
    count = _WARM_UP + max(2, round(minutes * 60 / _EVERY_S))
    for number in range(count):
        page.page.wait_for_timeout(max(0.0, begin_s + number * _EVERY_S - time.monotonic()) * 1000)
        one = _sample(studio, of_browser, of_page, int(page.page.evaluate(_NODES)))
        megabytes = (
            f"{one.server:9.1f}{one.workers:9.1f}{one.page:9.1f}{one.gpu:9.1f}{one.heap:9.1f}"
        )
        say(f"{time.monotonic() - begin_s:6.0f}{megabytes}{one.nodes:7}")
        yield one
    for error in page.errors:
        say(f"  the page said: {error[:200]}")
    judge_that("memory: the page had nothing to complain of", holds=not page.errors)
    context.close()


def _add_displays(studio: RunningStudio, topics: dict[str, str]) -> None:
    """One of each kind, each by its topic once somebody tells of it."""
    with studio.client() as client:
        document = client.get("/api/documents").json()["documents"][0]["id"]
        for kind in DISPLAYS:
            command = {"type": "add_display", "document": document, "kind": kind.KIND}
            answer = client.post(
                "/api/commands", json={**command, "topic": topics.get(kind.KIND, "")}
            )
            assert answer.is_success, answer.text


def _sample(
    studio: RunningStudio, of_browser: CDPSession, of_page: CDPSession, nodes: int
) -> Sample:
    processes = _ask(of_browser, "SystemInfo.getProcessInfo")["processInfo"]
    by_kind: dict[str, float] = {}
    for process in processes:
        by_kind[process["type"]] = by_kind.get(process["type"], 0.0) + _resident_mb(process["id"])
    _ask(of_page, "HeapProfiler.collectGarbage")
    heap = _ask(of_page, "Runtime.getHeapUsage")
    held = heap["usedSize"] + heap.get("backingStorageSize", 0)
    return Sample(
        _resident_mb(studio.pid),
        sum(map(_resident_mb, studio.children())),
        by_kind.get("renderer", 0.0),
        by_kind.get("GPU", 0.0),
        held / _MB,
        nodes,
    )


def _resident_mb(pid: int) -> float:
    """What a process holds of the machine's memory (Linux); 0 when it has ended."""
    try:
        status = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0.0
    line = next((one for one in status.splitlines() if one.startswith("VmRSS")), "VmRSS: 0 kB")
    return int(line.split()[1]) * 1024 / _MB


def _judge(samples: list[Sample]) -> None:
    """Growth from the first third to the last, by their medians: heaps breathe."""
    for name, at_most in (("server", 15.0), ("page", 40.0), ("GPU", 40.0), ("heap", 15.0)):
        values = [getattr(one, name.lower()) for one in samples]
        third = max(1, len(values) // 3)
        grown = statistics.median(values[-third:]) - statistics.median(values[:third])
        judge(f"memory: growth of the {name}", grown, at_most=at_most, unit="MB")


def _ask(session: CDPSession, method: str) -> Any:  # noqa: ANN401
    return session.send(method)  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
