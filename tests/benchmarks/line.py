"""Thirty browsers that join a meshed rover together over one line of 20 Mbit/s and 60 ms.

The studio is at one end of the line, the browsers are at the other, each in a network namespace.
The rover moves at 30 Hz and the presenter's camera at 20 Hz from before they come to the end. Cut
off, the line loses all packets for a while; once the lanes wait for it, once they end at the cut.
"""

from __future__ import annotations

import itertools
import json
import math
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.benchmarks import line_load
from tests.benchmarks.edit_to_websocket import Lane
from tests.benchmarks.line_link import NEAR, Link, NoLineError, link
from tests.benchmarks.report import judge, say
from tests.support.server import RunningStudio, running_studio

if TYPE_CHECKING:
    from collections.abc import Generator

BROWSERS, RUNS = 30, 3
RATE_BITS_PER_S, DELAY_S, QUEUE_S = 20e6, 0.030, 0.2
"""The delay is that of one direction; the queue is that of a usual router."""
_LOOK_S, _CUT_S, _RETURN_S, _REST_S = 5.0, 3.0, 12.0, 2.0
_NEVER_S = 99.0
_TICKS_HZ = 60
"""A third of them turns the camera, a half moves the joints."""


@dataclass(frozen=True)
class Seen:
    """What came of one class; a value for each browser, if not said otherwise."""

    there_s: list[float]
    """Until it had joined, and had the page, the state and all meshes."""
    came: list[int]
    """Bytes until then, and the editor's behind it."""
    hz: list[float]
    bytes_per_s: list[float]
    ages_s: list[float]
    """Of the presenter's views, of all browsers."""
    kept_s: list[float]
    """After the line was cut: until it was live again, though its lanes were kept."""
    ended_s: list[float]
    """The same, where its lanes had ended."""

    def __str__(self) -> str:
        """A row or two."""
        megabytes, ages_ms = max(self.came) / 1e6, [one * 1e3 for one in self.ages_s]
        middle = statistics.median
        return (
            f"all there in {max(self.there_s):5.1f} s ({megabytes:.2f} MB each); live at "
            f"{min(self.hz):.1f} Hz at least, p50 {middle(self.hz):.1f} Hz, "
            f"{middle(self.bytes_per_s) / 1e3:.0f} kB/s each, the presenter's view "
            f"p50 {middle(ages_ms):.0f} ms, p95 {p95(ages_ms):.0f} ms\n"
            f"  cut off for {_CUT_S:g} s and live again: p95 {p95(self.kept_s):.2f} s, at most "
            f"{max(self.kept_s):.2f} s; with lanes that ended p95 {p95(self.ended_s):.2f} s, at "
            f"most {max(self.ended_s):.2f} s"
        )


def run() -> None:
    """Measure, where the system lets us have such a line."""
    try:
        with link(RATE_BITS_PER_S, DELAY_S, QUEUE_S) as line, line.near():
            found = _measured(line)
    except NoLineError as error:
        say(f"skipped: this system gives us no such line: {error}")
        return
    for name, choose in (("best", min), ("median", statistics.median)):
        say(
            f"  {name} of {RUNS}: all there in {choose(max(one.there_s) for one in found):.1f} s, "
            f"back in {choose(p95(one.kept_s) for one in found):.2f} s, with lanes that ended in "
            f"{choose(p95(one.ended_s) for one in found):.2f} s"
        )
    there_s = statistics.median(max(one.there_s) for one in found)
    hz = statistics.median(min(one.hz) for one in found)
    judge("30 join over 20 Mbit/s and 60 ms", there_s, at_most=20, unit="s")
    judge("live there: from a picture to the next", 1e3 / hz, at_most=1e3 / 15)
    kept_s = statistics.median(p95(one.kept_s) for one in found)
    ended_s = statistics.median(p95(one.ended_s) for one in found)
    judge("cut off for 3 s: live again, p95", kept_s, at_most=5, unit="s")
    judge("cut off for 3 s, lanes ended: live again, p95", ended_s, at_most=5, unit="s")


def p95(values: list[float]) -> float:
    """The value that one in twenty passes."""
    return sorted(values)[round(0.95 * (len(values) - 1))]


def _measured(line: Link) -> list[Seen]:
    words = ["demo", "--share", "--host", "0.0.0.0"]  # of its namespace
    with tempfile.TemporaryDirectory() as scratch, ExitStack() as held:
        studio = held.enter_context(running_studio(words, Path(scratch) / "data"))
        lane = Lane(studio)
        held.callback(lane.close)
        with _presenting(lane, _joints(studio, lane.document)):
            found = [_class(line, studio, lane.document, number) for number in range(RUNS)]
        with _presenting(lane, []):
            lane.send("animate_joints", running=True)
            say("the same, the joints swung by the studio at 60 Hz:")
            _class(line, studio, lane.document, RUNS)
        return found


def _class(line: Link, studio: RunningStudio, document: str, number: int) -> Seen:
    """One class that comes, looks, is cut off twice, and goes."""
    names = [f"Student {number}.{one}" for one in range(BROWSERS)]
    job = line_load.Job(NEAR, studio.port, document, studio.class_code, names)
    with line.far():
        process = subprocess.Popen(
            [sys.executable, "-m", line_load.__name__, json.dumps(vars(job))],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
    assert process.stdin is not None
    try:
        came = _heard(process)
        time.sleep(_REST_S)
        seen = _ask(process, f"look {_LOOK_S}")
        backs: list[list[float]] = []
        for drops in (False, True):
            line.cut()
            if drops:
                _tell(process, "drop")
            time.sleep(_CUT_S)
            line.restore()
            restored_s = time.time()  # noqa: TID251 - of both processes
            time.sleep(_RETURN_S)
            back = _ask(process, f"back {restored_s}")
            backs.append([_NEVER_S if one is None else one for one in back["back_s"]])
            _tell(process, "forget")
    finally:
        process.stdin.close()
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()
    kept, ended = backs
    made = Seen(
        came["there_s"], came["came"], seen["hz"], seen["bytes_per_s"], seen["ages_s"], kept, ended
    )
    say(str(made))
    return made


@contextmanager
def _presenting(lane: Lane, joints: list[str]) -> Generator[None]:
    """Within this block the presenter's camera turns, joints are dragged, and lanes are read."""
    done = threading.Event()

    def turn() -> None:
        for tick in itertools.count():
            if done.wait(1 / _TICKS_HZ):
                return
            now_s = time.time() % 86_400  # noqa: TID251 - of both processes
            if tick % 3 == 0:
                lane.send("show_view", eye=[now_s // 60, (now_s % 60) * 1e3, 0.0], target=[0, 0, 0])
            if tick % 2 == 0 and joints:
                swing = 0.3 * math.sin(now_s)
                lane.send("set_joints", positions=dict.fromkeys(joints, swing))

    threads = [threading.Thread(target=turn)]
    lanes = (lane.control, lane.scene)
    threads += [threading.Thread(target=lane.read_until, args=(one, done)) for one in lanes]
    for one in threads:
        one.start()
    try:
        yield
    finally:
        done.set()
        for one in threads:
            one.join()


def _joints(studio: RunningStudio, document: str) -> list[str]:
    """Names of those that can be dragged."""
    with studio.websocket("/control") as lane:
        lane.send(json.dumps({"type": "watch", "document": document}))
        while (event := json.loads(lane.recv(timeout=10)))["type"] != "robot":
            pass
    return [one["name"] for one in event["joints"] if one["type"] != "fixed" and not one["mimic"]]


def _tell(process: subprocess.Popen[str], line: str) -> None:
    assert process.stdin is not None
    process.stdin.write(f"{line}\n")
    process.stdin.flush()


def _ask(process: subprocess.Popen[str], line: str) -> Any:  # noqa: ANN401
    _tell(process, line)
    return _heard(process)


def _heard(process: subprocess.Popen[str]) -> Any:  # noqa: ANN401
    assert process.stdout is not None
    return json.loads(process.stdout.readline())
