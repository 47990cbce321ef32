"""The page's first load, cold, on loopback, with the 3D view closed; and what a keystroke costs.

The 3D view draws in the page's own thread, and software GL would be in every figure: the layout
that is loaded has no 3D view. What an open one costs is said beside it, and asked of nobody.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.benchmarks.report import Timings, judge, judge_that, say, say_beside
from tests.support.browser import open_browser
from tests.support.server import running_studio

if TYPE_CHECKING:
    from collections.abc import Generator

    from playwright.sync_api import Browser, BrowserContext, CDPSession, Page, StorageState

RUNS = 5
_LOAD_KB = 400
_DOCKED_MS = 1000
_KEYSTROKE_MS = 16
_LINES = 5000
_KEYSTROKES = 60
_SIZE: Any = {"width": 1600, "height": 950}

_WATCH = """() => {
  window.shifted = 0;
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries()) window.shifted += entry.value;
  }).observe({ type: "layout-shift", buffered: true });
  const look = () => {
    if (!window.docked && document.querySelector(".dv-tab")) window.docked = performance.now();
    const filled = document.querySelector('[role="treeitem"]') && document.querySelector(".group");
    if (filled) window.filled = performance.now();
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}"""
"""`docked`: the panels stand; `filled`: those in front show the robot."""
_UNTIL_FILLED = """() => [
  ...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource"),
].filter((one) => one.responseEnd <= window.filled && !/\\/viser\\/(client.zst)?$/.test(one.name))
  .reduce((sum, one) => sum + one.transferSize, 0)"""
_REST = "() => window.filled && document.querySelector('.cm-line')"


@dataclass
class FirstLoad:
    """One cold load: bytes with their headers, and the page's own clock."""

    until_filled: int
    in_all: int
    viser: int
    docked_ms: float
    filled_ms: float
    shifted: float


class Transfer:
    """Counts what comes over the wire; `viser` is the page of the 3D view and its client."""

    def __init__(self, session: CDPSession) -> None:
        self.own = self.viser = 0
        self._urls: dict[str, str] = {}
        session.on("Network.responseReceived", self._began)
        session.on("Network.loadingFinished", self._ended)
        _ask(session, "Network.enable")

    def _began(self, event: dict[str, Any]) -> None:
        self._urls[event["requestId"]] = event["response"]["url"]

    def _ended(self, event: dict[str, Any]) -> None:
        size = int(event["encodedDataLength"])
        if self._urls.get(event["requestId"], "").endswith(("/viser/", "/viser/client.zst")):
            self.viser += size
        else:
            self.own += size


def run() -> None:
    """All of it, with one browser and one studio for each question."""
    for browser in open_browser():
        with tempfile.TemporaryDirectory() as scratch:
            with running_studio(["demo"], Path(scratch) / "data") as studio:
                closed = _without_scene(browser, studio.url)
                loads = [_load(browser, studio.url, closed) for _ in range(RUNS)]
                opened = [_load(browser, studio.url, None) for _ in range(RUNS)]
            _say_loads(loads, opened)
            _measure_keystrokes(browser, Path(scratch), closed)


def _context(browser: Browser, stored: StorageState | None) -> BrowserContext:
    return browser.new_context(viewport=_SIZE, reduced_motion="reduce", storage_state=stored)


def _without_scene(browser: Browser, url: str) -> StorageState:
    """What a browser remembers whose 3D view was closed."""
    context = _context(browser, None)
    page = context.new_page()
    page.goto(url)
    page.get_by_role("tab", name="3D view").click(button="right")
    page.get_by_role("menuitem", name="Close").click()
    page.wait_for_function(
        "() => Object.keys(localStorage).some((key) => key.startsWith('studio.layout.'))"
    )
    state = context.storage_state()
    context.close()
    return {"cookies": [], "origins": state.get("origins", [])}


def _load(browser: Browser, url: str, stored: StorageState | None) -> FirstLoad:
    context = _context(browser, stored)
    context.add_init_script(f"({_WATCH})()")
    page = context.new_page()
    transfer = Transfer(context.new_cdp_session(page))
    page.goto(url)
    page.wait_for_function(_REST)
    page.wait_for_load_state("networkidle")
    page.wait_for_timeout(500)
    told = {name: float(page.evaluate(name)) for name in ("docked", "filled", "shifted")}
    until_filled = int(page.evaluate(_UNTIL_FILLED))
    load = FirstLoad(
        until_filled, transfer.own, transfer.viser, told["docked"], told["filled"], told["shifted"]
    )
    context.close()
    return load


def _say_loads(loads: list[FirstLoad], opened: list[FirstLoad]) -> None:
    docked, filled = Timings("docked layout, 3D view closed"), Timings("panels filled")
    beside = Timings("docked layout, 3D view open")
    docked.values_ms = [one.docked_ms for one in loads]
    filled.values_ms = [one.filled_ms for one in loads]
    beside.values_ms = [one.docked_ms for one in opened]
    say_beside("first load, cold, Chromium, software GL", docked, filled, beside)
    say(f"  with the editor, which follows when the page is idle: {loads[0].in_all / 1000:.0f} kB")
    say(f"  an open 3D view adds viser's page: {opened[0].viser / 1000:.0f} kB")
    until_filled_kb = max(one.until_filled for one in loads) / 1000
    judge("transfer until the panels are filled", until_filled_kb, at_most=_LOAD_KB, unit="kB")
    judge("docked layout, 3D view closed", docked.median_ms, at_most=_DOCKED_MS)
    judge_that("nothing moves after it was drawn", holds=all(one.shifted == 0 for one in loads))


def _measure_keystrokes(browser: Browser, scratch: Path, closed: StorageState) -> None:
    """Type into a long file; the time of the page's scripts is the browser's own count."""
    path = scratch / "long.urdf.xacro"
    path.write_text("\n".join(_long_file()), encoding="utf-8")
    with running_studio(["open", str(path)], scratch / "data-long") as studio:
        context = _context(browser, _moved(closed, studio.origin))
        page = context.new_page()
        page.goto(studio.url)
        page.locator(".cm-line").first.click()
        page.keyboard.press("Control+End")
        page.keyboard.press("ArrowUp")
        page.keyboard.press("Home")
        session = context.new_cdp_session(page)
        _ask(session, "Performance.enable")
        costs = Timings(f"script of a keystroke in {_LINES} lines")
        costs.values_ms = list(_keystrokes(page, session))
        context.close()
    say_beside("typing a comment, 3D view closed", costs)
    judge("script of a keystroke in 5,000 lines", costs.median_ms, at_most=_KEYSTROKE_MS)


def _moved(stored: StorageState, origin: str) -> StorageState:
    """The same memory for a studio at another port."""
    kept = [{**one, "origin": origin} for one in stored.get("origins", [])]
    return {"cookies": [], "origins": kept}  # pyright: ignore[reportReturnType] - the same keys


def _long_file() -> Generator[str]:
    yield '<robot name="long" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    yield '  <link name="base"/>'
    for number in range(_LINES - 4):
        yield f'  <xacro:property name="length_{number}" value="{number / 1000}"/>'
    yield "  <!-- the end -->"
    yield "</robot>"


def _keystrokes(page: Page, session: CDPSession) -> Generator[float]:
    """Milliseconds of script for each, once what it began has come to rest."""
    page.keyboard.type("<!-- ")
    page.wait_for_timeout(1500)
    for _ in range(_KEYSTROKES):
        before = _script_ms(session)
        page.keyboard.type("a")
        page.wait_for_timeout(60)
        yield _script_ms(session) - before


def _script_ms(session: CDPSession) -> float:
    metrics: list[dict[str, Any]] = _ask(session, "Performance.getMetrics")["metrics"]
    return next(1000 * one["value"] for one in metrics if one["name"] == "ScriptDuration")


def _ask(session: CDPSession, method: str) -> dict[str, Any]:
    return session.send(method)  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
