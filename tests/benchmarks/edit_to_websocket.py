"""From an edit on the control lane to its bytes on the 3D lane, beside xacro's two ways.

No browser: a raw websocket stands for viser's page. The peers only expand; what comes after
(parsing, drawing, sending) is on our side of the scale alone. The bare round trip is the same
command in and the same number of bytes out, through the same process and the same lanes, between
the edits.
"""

from __future__ import annotations

import json
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from tests.benchmarks import echo_studio
from tests.benchmarks.report import Timings, judge, say, say_beside
from tests.benchmarks.robots import MeasuredRobot, corpus_robots, rover
from tests.benchmarks.stock import Stock
from tests.support.server import RunningStudio, running_process

if TYPE_CHECKING:
    from collections.abc import Generator
    from threading import Event

    from websockets.sync.connection import Connection

EDITS = 28
STOCK_RUNS = 7
_QUIET_S = 0.1
_PATIENCE_S = 10.0
_MESHES_QUIET_S = 2.0

Site: TypeAlias = dict[str, Any]


def run() -> None:
    """Measure the rover and, with a corpus, UR10e and PR2."""
    robots = [rover(), *corpus_robots()]
    for robot in robots:
        with tempfile.TemporaryDirectory() as folder:
            _measure(robot, Path(folder))
    if len(robots) == 1:
        say("UR10e and PR2 skipped: STUDIO_CORPUS names no folder")


def _measure(robot: MeasuredRobot, scratch: Path) -> None:
    ours, bare = (
        Timings("edit to bytes on the websocket"),
        Timings("bare round trip of these bytes"),
    )
    command, stock = Timings("the xacro command alone"), Timings("stock xacro in-process, warm")
    peer = Stock(robot, scratch)
    with running_echo(robot, scratch) as studio:
        lane = Lane(studio)
        site = lane.moving_site(robot.site)
        size_bytes = lane.edit_and_wait(site, 0)
        echo = Echo(studio, lane.command_of(site, 0), size_bytes)
        for number in range(1, EDITS + 1):
            with ours.measure():
                lane.edit_and_wait(site, number)
            lane.drain()
            with bare.measure():
                echo.round_trip()
            time.sleep(_QUIET_S)
            if number % (EDITS // STOCK_RUNS) == 0:
                with command.measure():
                    peer.by_command()
                with stock.measure():
                    peer.in_process()
        echo.close()
        lane.close()
    say_beside(f"{robot.name}: {site['name']}, {size_bytes} bytes", ours, bare, command, stock)
    judge(
        f"{robot.name}: edit to bytes p95, command / 15",
        ours.p95_ms,
        at_most=command.median_ms / 15,
    )
    judge(f"{robot.name}: edit to bytes p95, 5 bare trips", ours.p95_ms, at_most=5 * bare.p95_ms)


@contextmanager
def running_echo(robot: MeasuredRobot, scratch: Path) -> Generator[RunningStudio]:
    """The studio on a robot, with the bare websocket beside."""
    options = ["open", *robot.options(), "--no-browser", "--port", "0"]
    options += ["--data-dir", str(scratch / "data")]
    with running_process([echo_studio.__name__, *options], scratch / "stderr") as studio:
        yield studio


class Echo:
    """A bare round trip: the command of an edit in, as many bytes as its frame out."""

    def __init__(self, studio: RunningStudio, command: str, size_bytes: int) -> None:
        self._socket = studio.websocket(echo_studio.PATH)
        self._command = command
        self._socket.send(bytes(size_bytes))

    def round_trip(self) -> None:
        """Send, and wait for the answer."""
        self._socket.send(self._command)
        self._socket.recv(timeout=_PATIENCE_S)

    def close(self) -> None:
        """Close it."""
        self._socket.close()


class Lane:
    """A control lane and a 3D lane of the default document."""

    def __init__(self, studio: RunningStudio) -> None:
        with studio.client() as client:
            (document,) = client.get("/api/documents").json()["documents"]
        self.document: str = document["id"]
        self.control = studio.websocket("/control")
        self.scene = studio.websocket(f"/d/{self.document}/viser", "viser-v1.1.1")
        self.sites: dict[str, Site] = {}
        self.send("watch")
        self._until_opened()

    def moving_site(self, name: str) -> Site:
        """The first site of that name, or else any, whose edit changes the 3D view."""
        named = [one for one in self.sites.values() if one["name"].endswith(name)]
        known = sorted(self.sites.values(), key=lambda one: one["id"])  # they come in any order
        others = [one for one in known if one["number"] and one["reads"]]
        for site in (*named, *others):
            if site["number"] and self._moves(site):
                return site
        raise LookupError(name)

    def edit_and_wait(self, site: Site, number: int) -> int:
        """Edit, and wait for the frame that shows it; its size in bytes."""
        self.control.send(self.command_of(site, number))
        return len(self.scene.recv(timeout=_PATIENCE_S))

    def command_of(self, site: Site, number: int) -> str:
        """An edit as the page sends it."""
        edit = {"site": site["id"], "text": _text(site, number), "gesture": "bench"}
        return self._command("edit_site", **edit)

    def drain(self) -> None:
        """Read both lanes until nothing has come for a moment."""
        for lane in (self.scene, self.control):
            while (message := _receive(lane)) is not None:
                self._note(message)

    def read_until(self, lane: Connection, done: Event) -> None:
        """Read one of the lanes in a thread of its own: what is not read holds up its pings."""
        while not done.is_set():
            if (message := _receive(lane)) is not None:
                self._note(message)

    def close(self) -> None:
        """Close both lanes."""
        self.scene.close()
        self.control.close()

    def _moves(self, site: Site) -> bool:
        self.control.send(self.command_of(site, 1))
        moved = _receive(self.scene, 1.0) is not None
        self.drain()
        return moved

    def _until_opened(self) -> None:
        """Read until the robot is there and its lanes are still."""
        end_s = time.monotonic() + _PATIENCE_S
        while not self.sites and time.monotonic() < end_s:
            self.drain()
        while _receive(self.scene, _MESHES_QUIET_S) is not None:
            pass  # meshes: a frame of theirs is not that of an edit

    def send(self, kind: str, **fields: object) -> None:
        """Send any command, without waiting."""
        self.control.send(self._command(kind, **fields))

    def _command(self, kind: str, **fields: object) -> str:
        return json.dumps({"type": kind, "document": self.document, "request": 1, **fields})

    def _note(self, message: str | bytes) -> None:
        if isinstance(message, bytes) or '"type":"sites"' not in message:
            return
        for site in json.loads(message)["changed"]:
            self.sites[site["id"]] = site


def _receive(lane: Connection, timeout_s: float = _QUIET_S) -> str | bytes | None:
    try:
        return lane.recv(timeout=timeout_s)
    except TimeoutError:
        return None


def _text(site: Site, number: int) -> str:
    """A value near the written one, never the same twice in a row."""
    return f"{site['number'] * (1 + 0.01 * (1 + number % 20)):.5f}"
