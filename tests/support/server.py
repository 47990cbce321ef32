"""The real studio as a process of its own, as a person starts it."""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import parse_qs, urlsplit

import httpx2
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from tests.support.classmates import CLOSE_S
from tests.support.patience import Stopwatch, ended_within
from tests.support.warm_python import STUDIO, start_python

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator, Sequence

    from websockets.sync.connection import Connection

    from tests.support.warm_python import WarmProcess

START_TIMEOUT_S = 90.0
_LISTENING = "0A"
"""State of a socket in /proc/net/tcp."""
_END_TIMEOUT_S = 20.0


class StudioDidNotStartError(RuntimeError):
    """The studio ended, or said nothing in time; the message holds what it wrote to stderr."""


class RunningStudio:
    """A studio that has printed its address."""

    def __init__(
        self, process: subprocess.Popen[str] | WarmProcess, line: str, errors: Path
    ) -> None:
        self.process, self.line, self._errors = process, line, errors
        self.url = line.removeprefix("Studio: ")
        parts = urlsplit(self.url)
        self.port = parts.port or 0
        self.origin = f"http://{parts.netloc}"
        self.token = parse_qs(parts.query).get("token", [""])[0]

    @property
    def pid(self) -> int:
        """Process id of the studio itself."""
        return self.process.pid

    @cached_property
    def viewer_url(self) -> str:
        """The address for those who only look, which it prints next if it was asked to."""
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        assert line.startswith("Viewer: "), line
        return line.removeprefix("Viewer: ").strip()

    @cached_property
    def class_code(self) -> str:
        """The code of the class, which it prints once it is shared."""
        return self.next_line("Class: ").split()[-1]

    def next_line(self, words: str) -> str:
        """The next line that it prints with these words in it."""
        assert self.process.stdout is not None
        for line in iter(self.process.stdout.readline, ""):
            if words in line:
                return line
        raise StudioDidNotStartError(self.stderr)

    @property
    def stderr(self) -> str:
        """What it wrote there so far."""
        return self._errors.read_text(encoding="utf-8", errors="replace")

    @contextmanager
    def client(self) -> Generator[httpx2.Client]:
        """A client that came by the printed address and so has the cookie."""
        with httpx2.Client(
            base_url=self.origin,
            headers={"origin": self.origin},
            follow_redirects=True,
            trust_env=False,
            verify=False,  # of plain HTTP: to read certificates takes 20 ms
            timeout=60,
        ) as client:
            client.get(f"/?token={self.token}").raise_for_status()
            yield client

    def websocket(self, path: str, *subprotocols: str) -> Connection:
        """A websocket as the studio's own page opens it."""
        with self.client() as client:
            cookie = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
        return connect(
            f"ws://127.0.0.1:{self.port}{path}",
            origin=Origin(self.origin),
            subprotocols=[Subprotocol(one) for one in subprotocols] or None,
            additional_headers={"Cookie": cookie},
            proxy=None,
            open_timeout=60,
            max_size=None,
            close_timeout=CLOSE_S,
        )

    def hear_sites(self, document: str) -> None:
        """Wait until it has opened a robot: until then a page shows the one of before a restart."""
        with self.websocket("/control") as lane:
            lane.send(json.dumps({"type": "watch", "document": document}))
            while True:
                message = lane.recv(timeout=START_TIMEOUT_S)
                if isinstance(message, str) and json.loads(message)["type"] == "sites":
                    return

    def stop(self, number: signal.Signals = signal.SIGTERM) -> tuple[int, float]:
        """Send a signal; answers the exit code and the seconds it took to end, as `Stopwatch`."""
        watch = Stopwatch()
        self.process.send_signal(number)
        return ended_within(self.process, _END_TIMEOUT_S, watch), watch.s

    def listening_ports(self) -> set[int]:
        """Every TCP port that it or a worker of it listens on (Linux)."""
        inodes = {
            handle.stat().st_ino
            for pid in (self.pid, *self.children())
            for handle in Path(f"/proc/{pid}/fd").iterdir()
            if handle.exists()
        }
        rows = [
            line.split()
            for table in ("tcp", "tcp6")
            for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]
        ]
        return {
            int(row[1].rsplit(":", 1)[1], 16)
            for row in rows
            if row[3] == _LISTENING and int(row[9]) in inodes
        }

    def children(self) -> list[int]:
        """Process ids of its workers now (Linux)."""
        return list(_children(self.pid))


def _children(pid: int) -> Iterator[int]:
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in task.read_text().split():
            yield int(child)
            yield from _children(int(child))


@contextmanager
def running_studio(
    arguments: Sequence[str], data_folder: Path, *, port: int | None = 0, moving: bool = False
) -> Generator[RunningStudio]:
    """Start `studio` with these arguments, and end it with the block.

    Args:
        arguments: The command and its options, e.g. `["demo", "--fresh"]`.
        data_folder: Given as `--data-dir`; what it writes to stderr is kept beside.
        port: None leaves `--port` out; 0 lets the system choose.
        moving: With the node that drives the rover of `demo`, at the router that is named.

    Raises:
        StudioDidNotStartError: It printed no address in time.
    """
    options = ["--no-browser", "--data-dir", str(data_folder)]
    options += [] if port is None else ["--port", str(port)]
    options += ["--no-graph"] if arguments[0] == "demo" and not moving else []
    errors = data_folder.with_name(f"{data_folder.name}.stderr")
    with running_process(["studio", *arguments, *options], errors) as running:
        yield running


@contextmanager
def running_process(module: Sequence[str], errors: Path) -> Generator[RunningStudio]:
    """Run a module that prints its address, with stderr into a file, until the block ends.

    Within a test it finds imported what it needs; for whoever measures, it starts as it does.
    """
    is_test = "PYTEST_CURRENT_TEST" in os.environ
    with errors.open("w") as sink:
        process = start_python(
            [sys.executable, "-m", *module],
            os.environ,
            stderr=sink.fileno(),
            imported=STUDIO if is_test else (),
        )
    try:
        yield RunningStudio(process, _until_address(process, errors), errors)
    finally:
        process.terminate()
        try:
            process.wait(_END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stdout is not None:
            process.stdout.close()


def _until_address(process: subprocess.Popen[str] | WarmProcess, errors: Path) -> str:
    """The first line, which must be the address."""
    assert process.stdout is not None
    heard: queue.Queue[str] = queue.Queue()
    stdout = process.stdout
    reader = threading.Thread(target=lambda: heard.put(stdout.readline()), daemon=True)
    reader.start()
    try:
        line = heard.get(timeout=START_TIMEOUT_S)
    except queue.Empty:
        line = ""
    if not line.startswith("Studio: "):
        process.kill()
        raise StudioDidNotStartError(f"{line!r}\n{errors.read_text(errors='replace')}")
    return line.rstrip("\n")
