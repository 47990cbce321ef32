"""A class of 50 to 300 browsers that see a moving rover and follow, beside stock viser.

Each browser is two raw websockets, as its page has them: the 3D view and the control lane. One
process holds them all and throws away what comes; it takes less of the machine than the studio.
Where the whole machine is busier than 80 %, ages say more about it than about the studio.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.benchmarks import classroom_load, stock_viser
from tests.benchmarks.edit_to_websocket import Lane
from tests.benchmarks.fan_out import cpu_s_of
from tests.benchmarks.report import judge, judge_ratio, say
from tests.support.classmates import Classmate
from tests.support.server import RunningStudio, running_studio

if TYPE_CHECKING:
    from collections.abc import Generator

VIEWERS = (50, 100, 200, 300)
WINDOW_S = 5.0
_SETTLE_S = 1.5
_VIEWS_HZ = 20
_EDIT_EVERY = 5
"""Of so many views one is followed by an edit."""
_BUSY = 0.8
_MOVING_LINKS = 20


@dataclass(frozen=True)
class Seen:
    """What a class cost, and what it got."""

    cpu: float
    """Share of one core that the server took."""
    machine: float
    """Share of all cores that was taken, by whoever."""
    load_cpu: float
    hz: float
    bytes_per_s: float
    """Of one viewer."""
    ages_ms: list[float]
    edits_ms: list[float]
    joined_s: float


def run() -> None:
    """Measure the studio with each number of viewers, and stock viser with 200."""
    with tempfile.TemporaryDirectory() as scratch, ExitStack() as held:
        words = ["demo", "--share", "--host", "127.0.0.1"]
        studio = held.enter_context(running_studio(words, Path(scratch) / "data"))
        lane = Lane(studio)
        lane.send("animate_joints", running=True)
        cookies, joins_s = joined(studio.origin, studio.class_code, max(VIEWERS))
        say(f"100 join by the form, one after the other: {joins_s:.2f} s")
        with read_lanes(lane):
            found = {count: _measure(studio, lane, cookies[:count]) for count in VIEWERS}
        for count, seen in found.items():
            _tell(f"{count} browsers, the studio", count, seen)
        lane.close()
    with _stock() as (port, pid):
        stock = _watch(port, pid, "", [""] * 200, _do_nothing)
        _tell("200 viewers, stock viser", 200, stock)
    _judge(found, stock)


def _judge(found: dict[int, Seen], stock: Seen) -> None:
    mine = found[200]
    judge("200 browsers at 60 Hz: of a core", mine.cpu * 60 / mine.hz, at_most=0.45, unit="cores")
    cost = (stock.cpu / stock.hz) / (mine.cpu / mine.hz)
    judge_ratio("200 browsers: a frame costs stock viser", cost, at_least=3)
    for count, seen in found.items():
        if seen.machine > _BUSY:
            say(f"      {count}: the machine is busy ({seen.machine:.0%}), ages are told only")
            continue
        judge(f"{count} browsers: the presenter's view, p95", p95(seen.ages_ms), at_most=100)
        judge(f"{count} browsers: the presenter's edit, p95", p95(seen.edits_ms), at_most=200)


def _tell(what: str, count: int, seen: Seen) -> None:
    per_viewer_us = seen.cpu / count * 1e6
    say(
        f"{what:<28}{seen.hz:6.1f} Hz {seen.cpu:7.1%} of a core ({per_viewer_us:5.0f} us a viewer "
        f"and second), {seen.bytes_per_s / 1e3:6.1f} kB/s each; machine {seen.machine:.0%}, "
        f"load {seen.load_cpu:.0%}; all there in {seen.joined_s:.2f} s"
    )
    if seen.ages_ms and seen.edits_ms:
        say(
            f"{'':<28}view p50 {middle(seen.ages_ms):.1f} ms, p95 {p95(seen.ages_ms):.1f} ms; "
            f"edit p50 {middle(seen.edits_ms):.1f} ms, p95 {p95(seen.edits_ms):.1f} ms"
        )


def middle(values: list[float]) -> float:
    """The value in the middle, or the one above it."""
    return sorted(values)[len(values) // 2]


def p95(values: list[float]) -> float:
    """The value that one in twenty passes."""
    return sorted(values)[min(len(values) - 1, round(0.95 * (len(values) - 1)))]


def joined(address: str, code: str, count: int) -> tuple[list[str], float]:
    """Cookies of so many people, and the seconds that the first hundred took to join."""
    begin_s, took_s, cookies = time.perf_counter(), 0.0, list[str]()
    for number in range(count):
        one = Classmate(address)
        assert one.join(f"Student {number}", code).status_code == 303
        cookies.append(one.cookie)
        one.close()
        if number == 99:
            took_s = time.perf_counter() - begin_s
    return cookies, took_s


@contextmanager
def read_lanes(lane: Lane) -> Generator[None]:
    """Within this block both lanes are read, as a page does."""
    done = threading.Event()
    readers = [
        threading.Thread(target=lane.read_until, args=(one, done))
        for one in (lane.control, lane.scene)
    ]
    for one in readers:
        one.start()
    try:
        yield
    finally:
        done.set()
        for one in readers:
            one.join()


def _measure(studio: RunningStudio, lane: Lane, cookies: list[str]) -> Seen:
    def act(during: threading.Event) -> list[float]:
        return present(lane, during)

    return _watch(studio.port, studio.pid, lane.document, cookies, act)


def _do_nothing(_: threading.Event) -> list[float]:
    return []


def present(lane: Lane, during: threading.Event) -> list[float]:
    """Turn the camera and edit, as a presenter's page does; when each edit was sent."""
    site = next(one for one in lane.sites.values() if one["name"].endswith("wheel_radius"))
    sent_s: list[float] = []
    number = 0
    while not during.wait(1 / _VIEWS_HZ):
        number += 1
        now_s = time.time() % 86_400  # noqa: TID251 - of both processes
        eye = [now_s // 60, (now_s % 60) * 1e3, 0.0]
        lane.send("show_view", eye=eye, target=[0, 0, 0])
        if number % _EDIT_EVERY == 0:
            sent_s.append(time.time())  # noqa: TID251 - of both processes
            lane.control.send(lane.command_of(site, number))
    return sent_s


def _watch(
    port: int,
    pid: int,
    document: str,
    cookies: list[str],
    act: Any,  # noqa: ANN401
) -> Seen:
    job = classroom_load.Job("127.0.0.1", port, document, cookies, _SETTLE_S, WINDOW_S)
    process = subprocess.Popen(
        [sys.executable, "-m", classroom_load.__name__, json.dumps(vars(job))],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    joined_s: float = json.loads(process.stdout.readline())["joined_s"]
    done, sent_s = threading.Event(), list[float]()
    acting = threading.Thread(target=lambda: sent_s.extend(act(done)))
    acting.start()
    time.sleep(_SETTLE_S)
    begin_s, cpu_s, machine = time.perf_counter(), cpu_s_of(pid), machine_s()
    seen: dict[str, Any] = json.loads(process.stdout.readline())
    took_s = time.perf_counter() - begin_s
    busy, whole = (after - before for after, before in zip(machine_s(), machine, strict=True))
    spent = (cpu_s_of(pid) - cpu_s) / took_s
    done.set()
    acting.join()
    process.wait()
    process.stdout.close()
    return Seen(
        spent,
        busy / whole,
        seen["cpu_s"],
        seen["hz"],
        seen["bytes_per_s"],
        seen["ages_ms"],
        _after(sent_s, seen["built_s"], seen["since_s"]),
        joined_s,
    )


def _after(sent_s: list[float], lanes_s: list[list[float]], since_s: float) -> list[float]:
    """How long after its edit each lane was told of each run in the window, ms.

    The runs of a lane belong to the edits in their order: the lanes were there before the first.
    """
    took_ms: list[float] = []
    for built_s in lanes_s:
        runs_s = [at_s for at_s in built_s if sent_s and at_s >= sent_s[0]]
        assert len(runs_s) <= len(sent_s), "a run that no edit began"
        took_ms += [
            (at_s - edit_s) * 1e3
            for edit_s, at_s in zip(sent_s, runs_s, strict=False)
            if at_s >= since_s
        ]
    return took_ms


def machine_s() -> tuple[float, float]:
    """Ticks of all cores that were used, and all of them (Linux)."""
    ticks = [int(one) for one in Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
    return sum(ticks) - ticks[3] - ticks[4], sum(ticks)


@contextmanager
def _stock() -> Generator[tuple[int, int]]:
    process = subprocess.Popen(
        [sys.executable, "-m", stock_viser.__name__, str(_MOVING_LINKS)],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        said = iter(process.stdout.readline, "")
        port = next(int(line.split()[1]) for line in said if line.startswith("port "))
        yield port, process.pid
    finally:
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()
