"""A class by 0, 1, 2 and 4 relays: what the studio and each relay take, and how much later it is.

Relays have network namespaces of their own where the system lets us. Browsers are raw websockets
with three lanes each: control, the 3D view of a moving rover, and a topic; they are in processes of
their own, one for each relay, in its namespace. What these take is not counted.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import urlsplit

from studio.ros.messages import message
from tests.benchmarks import classroom, classroom_load, relays_load
from tests.benchmarks.edit_to_websocket import Lane
from tests.benchmarks.fan_out import cpu_s_of
from tests.benchmarks.relays_places import inside, places
from tests.benchmarks.relays_running import MeasuredRelay, measured_relay, rss_bytes_of
from tests.benchmarks.relays_verdicts import Rooms, Seen, Window, judge_all
from tests.support.demos import node_at
from tests.support.server import running_studio
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

    from tests.benchmarks.relays_places import Place
    from tests.support.server import RunningStudio

RELAYS: Final = (0, 1, 2, 4)
VIEWERS: Final = (0, 1, 25, 100, 200)
"""Of all relays together; with 1 there is one at each relay."""
ROOMS: Final = 4
WINDOWS: Final = 3
WINDOW_S: Final = 4.0
_SETTLE_S: Final = 2.0
_TRIES: Final = 2
_QUIET: Final = 0.4
_QUIET_WITHIN_S: Final = 10.0
_TOPIC: Final = "/marked"
_TOPIC_HZ: Final = 50


@dataclass(frozen=True)
class Door:
    """Where browsers come in: the studio itself, or its room at a relay."""

    address: str
    cookies: list[str]
    """Of who has joined there; the first is that of the sampler."""
    relay: MeasuredRelay | None = None

    @property
    def namespace(self) -> str:
        """File of the network namespace in which its browsers are."""
        return self.relay.place.path if self.relay else ""

    def job(self, document: str, cookies: list[str]) -> classroom_load.Job:
        """What so many browsers are told."""
        parts = urlsplit(self.address)
        return classroom_load.Job(
            parts.hostname or "",
            parts.port or 0,
            document,
            cookies,
            _SETTLE_S,
            WINDOWS * WINDOW_S + 2,
            parts.path.rstrip("/"),
            _TOPIC,
        )


def run() -> None:
    """Measure each number of relays with each number of browsers."""
    with running_router() as router, _marked(router), places(max(RELAYS)) as found:
        rooms = _rooms(found[0])
        seen = [one for count in RELAYS for one in _measured(router, found[:count])]
    judge_all(seen, rooms)


@contextmanager
def _marked(router: str) -> Generator[None]:
    """Publish a topic within this block."""
    kind = message("std_msgs/msg/String")
    with node_at(router, "marked") as node:
        publisher = node.create_publisher(kind, _TOPIC, 10)
        timer = node.create_timer(1 / _TOPIC_HZ, lambda: publisher.publish(kind(data="m" * 64)))
        yield
        node.destroy_timer(timer)


def _measured(router: str, found: Sequence[Place]) -> Generator[Seen]:
    with tempfile.TemporaryDirectory() as scratch, ExitStack() as held:
        folder = Path(scratch)
        relays = [
            held.enter_context(measured_relay(place, folder / f"relay-{number}"))
            for number, place in enumerate(found)
        ]
        words = ["demo", "--share", "--host", "127.0.0.1", "--connect", router, "--router", "off"]
        words += [word for one in relays for word in ("--via", one.line)]
        studio = held.enter_context(running_studio(words, folder / "data"))
        doors = _doors(studio, relays)
        lane = Lane(studio)
        held.callback(lane.close)
        lane.control.send(json.dumps({"type": "connect_wire", "request": 1}))
        lane.send("animate_joints", running=True)
        held.enter_context(classroom.read_lanes(lane))
        for viewers in VIEWERS:
            yield _quietest(studio, lane, doors, viewers)


def _doors(studio: RunningStudio, relays: Sequence[MeasuredRelay]) -> list[Door]:
    """All doors, the studio's first; people have joined at those through which many come."""
    code = studio.class_code
    found = [_room(studio) for _ in relays]
    rooms = {urlsplit(one).netloc: one for one in found}
    count = max(VIEWERS) // max(1, len(relays)) + 1
    own = classroom.joined(studio.origin, code, 1 if relays else count)[0]
    doors = [Door(studio.origin, own)]
    for relay in relays:
        address = rooms[urlsplit(relay.address).netloc]
        doors.append(Door(address, classroom.joined(address, code, count)[0], relay))
    return doors


def _room(studio: RunningStudio) -> str:
    return studio.next_line("Relay: ").removeprefix("Relay: ").split()[0]


def _quietest(studio: RunningStudio, lane: Lane, doors: list[Door], viewers: int) -> Seen:
    """Measure, and again where others kept the machine busy."""
    tries: list[Seen] = []
    while not tries or (tries[-1].is_disturbed and len(tries) < _TRIES):
        tries.append(_watched(studio, lane, doors, viewers))
        tries[-1].tell()
    return min(tries, key=lambda one: one.cost.machine)


def _watched(studio: RunningStudio, lane: Lane, doors: list[Door], viewers: int) -> Seen:
    relays = [one.relay for one in doors if one.relay]
    busy = doors[1:] or doors
    each = viewers // len(busy) if viewers > 1 else 0
    done = threading.Event()
    acting = threading.Thread(target=classroom.present, args=(lane, done))
    _wait_quiet()
    with ExitStack() as held:
        loads = [held.enter_context(_Load.of(one, lane.document, each)) for one in busy if each]
        sampler = held.enter_context(_Load.sampler(doors, lane.document)) if viewers else None
        for one in (*loads, *([sampler] if sampler else [])):
            one.line()
        acting.start()
        time.sleep(_SETTLE_S)
        windows = [_window(studio.pid, relays) for _ in range(WINDOWS)]
        told = [one.line() for one in loads]
        ages = sampler.line() if sampler else {}
        done.set()
        acting.join()
    return Seen.of(len(relays), viewers, windows, told, ages)


def _window(pid: int, relays: list[MeasuredRelay]) -> Window:
    def spent() -> list[float]:
        lines = [one.line_bytes() for one in relays]
        return [
            cpu_s_of(pid),
            sum(cpu_s_of(one.pid) for one in relays),
            sum(one.down for one in lines),
            sum(one.up for one in lines),
            sum(one.place.line_bytes() for one in relays),
            *classroom.machine_s(),
        ]

    begin_s, before = time.perf_counter(), spent()
    time.sleep(WINDOW_S)
    after, took_s = spent(), time.perf_counter() - begin_s
    studio, *rates, busy, whole = (
        (new - old) / took_s for new, old in zip(after, before, strict=True)
    )
    relay, down, up, wire = (one / max(1, len(relays)) for one in rates)
    memory = [rss_bytes_of(one.pid) for one in relays]
    return Window(
        studio,
        relay,
        down,
        up,
        wire,
        busy / whole,
        rss_bytes_of(pid),
        statistics.mean(memory) if memory else 0.0,
    )


def _wait_quiet() -> None:
    """Wait for a while until others on this machine rest: beside them everything costs more."""
    end_s = time.monotonic() + _QUIET_WITHIN_S
    while time.monotonic() < end_s:
        before = classroom.machine_s()
        time.sleep(1.0)
        busy, whole = (new - old for new, old in zip(classroom.machine_s(), before, strict=True))
        if busy < _QUIET * whole:
            return


class _Load:
    """A process of browsers, within this block; it says that they are there, and what they saw."""

    def __init__(self, module: str, job: dict[str, Any], namespace: str) -> None:
        with inside(namespace):
            self._process = subprocess.Popen(
                [sys.executable, "-m", module, json.dumps(job)],
                stdout=subprocess.PIPE,
                text=True,
            )

    @classmethod
    def of(cls, door: Door, document: str, count: int) -> _Load:
        """So many at a door."""
        job = door.job(document, door.cookies[1 : count + 1])
        return cls(classroom_load.__name__, asdict(job), door.namespace)

    @classmethod
    def sampler(cls, doors: list[Door], document: str) -> _Load:
        """One at each door, in one process."""
        found = [
            {"job": asdict(one.job(document, one.cookies[:1])), "namespace": one.namespace}
            for one in doors
        ]
        times = {"settle_s": _SETTLE_S, "window_s": WINDOWS * WINDOW_S}
        return cls(relays_load.__name__, {"places": found, **times}, "")

    def line(self) -> dict[str, Any]:
        """What it says next."""
        assert self._process.stdout is not None
        return json.loads(self._process.stdout.readline())

    def __enter__(self) -> _Load:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()


def _rooms(place: Place) -> Rooms:
    """Have one studio after the other at one relay, each with one browser."""
    with tempfile.TemporaryDirectory() as scratch, ExitStack() as held:
        folder = Path(scratch)
        relay = held.enter_context(measured_relay(place, folder / "relay"))
        memory, cpu = [float(rss_bytes_of(relay.pid))], [0.0]
        for number in range(ROOMS):
            words = ["demo", "--share", "--host", "127.0.0.1", "--via", relay.line]
            studio = held.enter_context(running_studio(words, folder / f"data-{number}"))
            lane = Lane(studio)
            held.callback(lane.close)
            lane.send("animate_joints", running=True)
            held.enter_context(classroom.read_lanes(lane))
            code = studio.class_code
            door = Door(found := _room(studio), classroom.joined(found, code, 2)[0], relay)
            held.enter_context(_Load.of(door, lane.document, 1)).line()
            time.sleep(_SETTLE_S)
            cpu.append(_window(studio.pid, [relay]).relay)
            memory.append(float(rss_bytes_of(relay.pid)))
    return Rooms(cpu, memory)
