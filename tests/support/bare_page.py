"""A page in a Chromium that nobody listens in on.

Playwright has its browser tell of every frame of every WebSocket, as text in a base of 64: that
takes eight times as long as the frame itself. Who measures streams asks this page.
"""

from __future__ import annotations

import itertools
import json
import os
import signal
import subprocess
import tempfile
import urllib.request
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from websockets.sync.client import connect

from tests.support.browser import FLAGS, ensure_chromium
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from websockets.sync.connection import Connection

_ENDS_WITHIN_S = 20.0


class PageLeftError(AssertionError):
    """The page that was asked is no more."""


class BarePage:
    """The one tab; its only way out is to evaluate scripts."""

    def __init__(self, devtools: Connection, pid: int) -> None:
        self._devtools, self.pid = devtools, pid
        self._ids = itertools.count(1)

    def evaluate(self, script: str) -> Any:  # noqa: ANN401
        """The value of an expression, or what its promise gives."""
        asked = next(self._ids)
        arguments = {"expression": script, "returnByValue": True, "awaitPromise": True}
        self._devtools.send(
            json.dumps({"id": asked, "method": "Runtime.evaluate", "params": arguments})
        )
        while (answer := json.loads(self._devtools.recv())).get("id") != asked:
            pass
        if "result" not in answer:  # it is on its way to another address
            raise PageLeftError(answer)
        result = answer["result"]
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def until(self, condition: str) -> None:
        """Wait until an expression holds."""
        wait_until(condition, lambda: self._holds(condition))

    def _holds(self, condition: str) -> bool:
        try:
            return bool(self.evaluate(f"Boolean({condition})"))
        except PageLeftError:
            return False


@contextmanager
def bare_page(url: str, width: int, height: int) -> Generator[BarePage]:
    """A browser of its own that shows this address, closed afterwards."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        words = [str(ensure_chromium()), *FLAGS, f"--user-data-dir={profile}"]
        words += ["--remote-debugging-port=0", f"--window-size={width},{height}", url]
        process = subprocess.Popen(
            words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
        )
        try:
            with connect(_address(Path(profile)), max_size=None, proxy=None) as devtools:
                yield BarePage(devtools, process.pid)
        finally:
            _end(process)


def _address(profile: Path) -> str:
    """Where the browser takes orders for its tab."""
    file = profile / "DevToolsActivePort"
    wait_until("the browser's port", lambda: file.exists() and "\n" in file.read_text())
    port = file.read_text().split()[0]

    def tabs() -> list[dict[str, str]]:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list") as answer:
            return [one for one in json.load(answer) if one["type"] == "page"]

    wait_until("the browser's tab", lambda: bool(tabs()))
    return tabs()[0]["webSocketDebuggerUrl"]


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the browser and all that it started: Debian's command is a shell that waits for it."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGTERM)
    with suppress(subprocess.TimeoutExpired):
        process.wait(_ENDS_WITHIN_S)
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def processor_s(pid: int) -> float:
    """Seconds of processor that a process and all that it started have taken so far (Linux)."""
    taken = 0.0
    with suppress(OSError):
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(") ")[2].split()
        taken = (int(fields[11]) + int(fields[12])) / 100
        for task in Path(f"/proc/{pid}/task").glob("*/children"):
            taken += sum(processor_s(int(child)) for child in task.read_text().split())
    return taken
