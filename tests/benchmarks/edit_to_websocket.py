"""From an edit on the control lane to its bytes on the 3D lane, beside xacro's two ways.

No browser: a raw websocket stands for viser's page. The peers only expand; what comes after
(parsing, drawing, sending) is on our side of the scale alone.
"""

from __future__ import annotations

import json
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from tests.benchmarks.report import Timings, say, say_beside
from tests.benchmarks.robots import MeasuredRobot, corpus_robots, rover
from tests.benchmarks.stock import Stock
from tests.support.server import RunningStudio, running_studio

if TYPE_CHECKING:
    from websockets.sync.connection import Connection

EDITS = 40
STOCK_RUNS = 7
_QUIET_S = 0.4
_PATIENCE_S = 10.0

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
    ours = Timings("edit to bytes on the websocket")
    command, stock = Timings("the xacro command alone"), Timings("stock xacro in-process, warm")
    peer = Stock(robot, scratch)
    with running_studio(["open", *robot.options()], scratch / "data") as studio:
        lane = Lane(studio)
        site = lane.moving_site(robot.site)
        for number in range(EDITS):
            with ours.measure():
                lane.edit_and_wait(site, number)
            lane.drain()
            if number % (EDITS // STOCK_RUNS) == 0:
                with command.measure():
                    peer.by_command()
                with stock.measure():
                    peer.in_process()
        lane.close()
    say_beside(f"{robot.name}: {site['name']}", ours, command, stock)


class Lane:
    """A control lane and a 3D lane of the default document."""

    def __init__(self, studio: RunningStudio) -> None:
        with studio.client() as client:
            (document,) = client.get("/api/documents").json()["documents"]
        self.document: str = document["id"]
        self.control = studio.websocket("/control")
        self.scene = studio.websocket(f"/d/{self.document}/viser", "viser-v1.1.1")
        self.sites: dict[str, Site] = {}
        self._send("watch")
        self._until_opened()

    def moving_site(self, name: str) -> Site:
        """The first site of that name, or else any, whose edit changes the 3D view."""
        named = [one for one in self.sites.values() if one["name"].endswith(name)]
        others = [one for one in self.sites.values() if one["number"] and one["reads"]]
        for site in (*named, *others):
            if site["number"] and self._moves(site):
                return site
        raise LookupError(name)

    def edit_and_wait(self, site: Site, number: int) -> None:
        """Edit, and wait for the frame that shows it."""
        self._send("edit_site", site=site["id"], text=_text(site, number), gesture="bench")
        self.scene.recv(timeout=_PATIENCE_S)

    def drain(self) -> None:
        """Read both lanes until nothing has come for a moment."""
        for lane in (self.scene, self.control):
            while (message := _receive(lane)) is not None:
                self._note(message)

    def close(self) -> None:
        """Close both lanes."""
        self.scene.close()
        self.control.close()

    def _moves(self, site: Site) -> bool:
        self._send("edit_site", site=site["id"], text=_text(site, 1), gesture="bench")
        moved = _receive(self.scene, 1.0) is not None
        self.drain()
        return moved

    def _until_opened(self) -> None:
        """Read until the robot is there and its lanes are still."""
        end_s = time.monotonic() + _PATIENCE_S
        while not self.sites and time.monotonic() < end_s:
            self.drain()

    def _send(self, kind: str, **fields: object) -> None:
        command = {"type": kind, "document": self.document, "request": 1, **fields}
        self.control.send(json.dumps(command))

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
