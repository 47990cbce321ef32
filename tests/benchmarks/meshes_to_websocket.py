"""From opening a robot to its last mesh on the 3D lane, beside yourdfpy and the bare parsing.

Mesh workers are warm; the cache is empty for the first row and on disk for the second. yourdfpy is
measured after its import, and "bare" is trimesh reading each distinct mesh file once.
"""

# pyright: reportUnknownMemberType=false, reportMissingTypeStubs=false
from __future__ import annotations

import json
import re
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import trimesh
import yourdfpy

from studio.description.evaluator.stock_xacro import export_urdf
from tests.benchmarks.report import Timings, say, say_beside
from tests.benchmarks.robots import MeasuredRobot, corpus, rover
from tests.support.descriptions import policy_for
from tests.support.server import RunningStudio, running_studio

if TYPE_CHECKING:
    from collections.abc import Iterable

RUNS = 3
_QUIET_S = 0.5
_PATIENCE_S = 60.0
_WARM_S = 3.0
_MESH = re.compile(r'<mesh\b[^>]*\bfilename\s*=\s*"([^"]+)"')


def run() -> None:
    """Measure ANYmal C, UR10e and turtlebot4."""
    folder = corpus()
    if folder is None:
        say("skipped: STUDIO_CORPUS names no folder")
        return
    for robot in _robots(folder):
        _measure(robot, folder)


def _robots(folder: Path) -> Iterable[MeasuredRobot]:
    """Each with the folder that a person would open; turtlebot4 needs another repository."""
    anymal = next(folder.rglob("urdf/anymal.urdf"))
    yield MeasuredRobot("ANYmal C", anymal, packages=anymal.parents[1])
    ur = next(folder.rglob("ur.urdf.xacro"))
    yield MeasuredRobot("UR10e", ur, ("ur_type:=ur10e", "name:=ur"), packages=ur.parents[1])
    turtlebot = next(folder.rglob("standard/turtlebot4.urdf.xacro"))
    yield MeasuredRobot("turtlebot4", turtlebot, packages=folder)


def _measure(robot: MeasuredRobot, folder: Path) -> None:
    cold, warm = Timings("open to last mesh, cache empty"), Timings("open to last mesh, cache full")
    load, bare = Timings("yourdfpy.URDF.load"), Timings("each distinct mesh parsed once, bare")
    peer = Peer(robot, folder)
    for _ in range(RUNS):
        with tempfile.TemporaryDirectory() as scratch:
            for timings in (cold, warm):
                timings.values_ms.append(_opened_ms(robot, Path(scratch) / "data"))
        with load.measure():
            peer.load()
        with bare.measure():
            peer.parse_each_once()
    say_beside(f"{robot.name}: {len(peer.files)} mesh files", cold, load, bare)
    say_beside("", warm, load, bare)


def _opened_ms(robot: MeasuredRobot, data: Path) -> float:
    """Milliseconds from the command that opens the robot to the last frame that came of it."""
    options = ["open", str(rover().file), "--package-path", str(robot.packages)]
    with running_studio(options, data) as studio:
        time.sleep(_WARM_S)  # the workers warm up in the background, which nothing tells
        return Opening(studio).measure_ms(robot)


@dataclass
class Opening:
    """Opens a robot in a running studio as its page does."""

    studio: RunningStudio

    def measure_ms(self, robot: MeasuredRobot) -> float:
        """Open, watch, and read the 3D lane until all meshes are said to be there."""
        control = self.studio.websocket("/control")
        begin_s = time.perf_counter()
        command = {"type": "open_path", "request": 1, "path": str(robot.file)}
        control.send(json.dumps({**command, "arguments": robot.mappings()}))
        document = ""
        while not document:
            event = json.loads(control.recv(timeout=_PATIENCE_S))
            document = event.get("document", "") if event["type"] == "opened" else ""
        control.send(json.dumps({"type": "watch", "document": document}))
        scene = self.studio.websocket(f"/d/{document}/viser", "viser-v1.1.1")
        last_s = begin_s
        while True:
            try:
                scene.recv(timeout=_QUIET_S)
                last_s = time.perf_counter()
            except TimeoutError:
                if self._is_complete(control) or time.perf_counter() - begin_s > _PATIENCE_S:
                    break
        scene.close()
        control.close()
        return (last_s - begin_s) * 1000

    def _is_complete(self, control: object) -> bool:
        """Whether the newest progress of the meshes says that all are there."""
        done = False
        while True:
            try:
                message = control.recv(timeout=0.01)  # type: ignore[attr-defined]
            except TimeoutError:
                return done
            if isinstance(message, str) and '"type":"progress"' in message:
                event = json.loads(message)
                done = event["done"] >= event["total"] > 0


class Peer:
    """yourdfpy and trimesh on the same robot."""

    def __init__(self, robot: MeasuredRobot, folder: Path) -> None:
        self._policy = policy_for(folder)
        text = export_urdf(str(robot.file), robot.mappings(), self._policy)
        self._entry = robot.file
        self._urdf = Path(tempfile.mkstemp(suffix=".urdf")[1])
        self._urdf.write_text(text)
        uris = dict.fromkeys(_MESH.findall(text))
        self.files = [path for path in map(self._find, uris) if Path(path).is_file()]

    def load(self) -> None:
        """As viser's URDF example does."""
        yourdfpy.URDF.load(str(self._urdf), filename_handler=self._handle)

    def _handle(self, fname: str) -> str:
        """yourdfpy passes the name by keyword."""
        return self._find(fname)

    def parse_each_once(self) -> None:
        """Nothing but reading."""
        for file in self.files:
            trimesh.load(file)

    def _find(self, uri: str) -> str:
        if uri.startswith("package://"):
            package, _, rest = uri.removeprefix("package://").partition("/")
            return str(Path(self._policy.packages[package][0]) / rest)
        return str(self._entry.parent / uri.removeprefix("file://"))
