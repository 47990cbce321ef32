"""The data lane beside foxglove-sdk's server and a plain FastAPI loop: a few topics, many browsers.

All hear the same topics over Zenoh from a process that publishes them, in turn and several times
over. Browsers are sockets in processes of their own; a row counts only while none of these takes
0.9 of a core. Where foxglove-sdk cannot be imported, it is left out.
"""

from __future__ import annotations

import importlib.util
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, Final, cast

from studio.live.topics.frames import LARGE_BYTES
from tests.benchmarks import data_browsers, data_server
from tests.benchmarks.data_browsers import Counted, Job
from tests.benchmarks.data_cells import BUSY, CELLS, SLOW, SLOW_BYTES_PER_S, Cell
from tests.benchmarks.fan_out import cpu_s_of
from tests.benchmarks.report import judge, judge_ratio, say
from tests.support.server import running_studio
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator

RUNS: Final = 3
WINDOW_S: Final = 3.0
OVER_EMPTY: Final = 1.5
"""Of a callback that does nothing."""
_SETTLE_S: Final = 1.0
_SLOW_WINDOW_S: Final = 5.0
_MEGABYTE: Final = 1e6
_PAGE_BYTES: Final = 4096


@dataclass(frozen=True)
class Server:
    """Where to hear, and whose processor is measured."""

    job: Job
    pid: int

    @property
    def name(self) -> str:
        """What it is called in the table."""
        return self.job.kind


@dataclass(frozen=True)
class Seen:
    """What one run showed."""

    cpu: float
    """Of the server, in cores."""
    hz: float
    """What the browser in the middle got of each topic."""
    p50_ms: float
    p95_ms: float
    load: float
    """What the busiest process of browsers took, in cores."""

    @property
    def cost(self) -> float:
        """Cores for one message in a second to all: who drops messages is not cheaper by that."""
        return self.cpu / self.hz if self.hz else math.inf


def run() -> None:
    """Measure every cell with every server in turn, again and again."""
    with running_router() as endpoint, tempfile.TemporaryDirectory() as scratch:
        port = int(endpoint.rpartition(":")[2])
        with ExitStack() as stack:
            servers = [stack.enter_context(_studio(endpoint, Path(scratch)))]
            kinds = ["naive", "empty"]
            if importlib.util.find_spec("foxglove"):
                kinds.append("foxglove")
            else:
                say("  foxglove-sdk is not installed: beside a plain FastAPI loop alone")
            servers += [stack.enter_context(_other(kind, port)) for kind in kinds]
            say(f"  an idle studio takes {_idle(servers[0]):.1%} of a core")
            for cell in CELLS:
                _measure(servers, port, cell)
            for server in servers:
                if server.name != "empty":
                    _slow(server, port)


def _idle(server: Server) -> float:
    begin_s, cpu_s = time.perf_counter(), cpu_s_of(server.pid)
    time.sleep(WINDOW_S)
    return (cpu_s_of(server.pid) - cpu_s) / (time.perf_counter() - begin_s)


def _measure(servers: list[Server], port: int, cell: Cell) -> None:
    say(f"  {cell}")
    chosen = [one for one in servers if one.name not in cell.left_out]
    found: dict[str, list[Seen]] = {server.name: [] for server in chosen}
    with _publishing(port, cell):
        for turn in range(RUNS):
            for server in chosen[:: -1 if turn % 2 else 1]:
                found[server.name].append(_watch(server, cell))
    middle = {name: _middle(seen) for name, seen in found.items()}
    for name, seen in middle.items():
        say(
            f"    {name:<10}{seen.cpu:7.1%} of a core   {seen.hz:8.1f} Hz"
            f"   p50 {seen.p50_ms:7.2f} ms   p95 {seen.p95_ms:7.2f} ms   load {seen.load:4.0%}"
        )
    _judge(middle, cell)


def _middle(runs: list[Seen]) -> Seen:
    def middle(name: str) -> float:
        return statistics.median(getattr(one, name) for one in runs)

    load = max(one.load for one in runs)
    return Seen(middle("cpu"), middle("hz"), middle("p50_ms"), middle("p95_ms"), load)


def _judge(middle: dict[str, Seen], cell: Cell) -> None:
    ours, naive, sdk = middle["studio"], middle.get("naive"), middle.get("foxglove")
    if naive is not None:
        say(f"    a message takes {ours.cost / naive.cost:.2f} of a plain loop's CPU")
    if sdk is not None:
        _judge_beside(ours, sdk, cell)
    if cell.over_empty:
        over = ours.cpu / middle["empty"].cpu
        judge(f"{cell}: CPU over an empty callback", over, at_most=OVER_EMPTY, unit="times")


def _judge_beside(ours: Seen, sdk: Seen, cell: Cell) -> None:
    if max(sdk.load, ours.load) > BUSY:
        say(f"    {cell}: not measurable here")
        return
    if cell.cpu_at_most:
        judge(f"{cell}: CPU", ours.cost / sdk.cost, at_most=cell.cpu_at_most, unit="times")
    if cell.p50_at_most:
        judge(f"{cell}: p50", ours.p50_ms / sdk.p50_ms, at_most=cell.p50_at_most, unit="times")


def _watch(server: Server, cell: Cell) -> Seen:
    if server.name == "empty":
        return Seen(_idle(server), 0.0, 0.0, 0.0, 0.0)
    return _watch_many(server, cell, cell.browsers, WINDOW_S)


def _window(
    server: Server, heard: list[subprocess.Popen[str]], cell: Cell, window_s: float
) -> Seen:
    time.sleep(_SETTLE_S)
    for process in heard:
        _order(process, "begin")
    begin_s, cpu_s = time.perf_counter(), cpu_s_of(server.pid)
    time.sleep(window_s)
    took_s = time.perf_counter() - begin_s
    cpu = (cpu_s_of(server.pid) - cpu_s) / took_s
    for process in heard:
        _order(process, "end")
    counted = [Counted(**json.loads(_line(process))) for process in heard]
    came = sorted(count for one in counted for count in one.messages)
    delays_ms = sorted(delay for one in counted for delay in one.delays_ms)
    assert delays_ms, f"nothing came from {server.name}"
    if hung_up := sum(one.hung_up for one in counted):
        say(f"    {server.name} hung up on {hung_up} of {cell.browsers} browsers")
    return Seen(
        cpu,
        came[len(came) // 2] / took_s / cell.topics,
        delays_ms[len(delays_ms) // 2],
        delays_ms[int(0.95 * len(delays_ms))],
        max(one.load for one in counted),
    )


def _job(server: Server, cell: Cell) -> Job:
    return replace(server.job, words=_words(server, cell), large=cell.size > LARGE_BYTES)


def _words(server: Server, cell: Cell) -> tuple[str, ...]:
    """What a browser says first."""
    numbers = range(cell.topics)
    if server.name == "studio":
        commands = (
            {
                "type": "subscribe",
                "subscription": number,
                "topic": data_server.topic(number),
                **cell.subscription,
            }
            for number in numbers
        )
        return tuple(json.dumps(command) for command in commands)
    chosen = [{"id": number + 1, "channelId": number + 1} for number in numbers]
    subscribe = json.dumps({"op": "subscribe", "subscriptions": chosen})
    return (subscribe,) if server.name == "foxglove" else ()


def _slow(server: Server, port: int) -> None:
    """One of the browsers reads slowly: what that takes from the others, and how much memory."""
    slow = replace(_job(server, SLOW), browsers=1, sips_bytes_per_s=SLOW_BYTES_PER_S)
    with _publishing(port, SLOW):
        alone = _watch_many(server, SLOW, SLOW.browsers - 1, _SLOW_WINDOW_S)
        before = _memory_bytes(server.pid)
        with _browsers(slow):
            seen = _watch_many(server, SLOW, SLOW.browsers - 1, _SLOW_WINDOW_S)
            grown = (_memory_bytes(server.pid) - before) / _MEGABYTE
    say(
        f"    {server.name:<10}{alone.hz:5.1f} Hz to 9, {seen.hz:5.1f} Hz beside a slow one,"
        f" memory {grown:+.0f} MB   load {max(alone.load, seen.load):4.0%}"
    )
    if server.name == "studio" and max(alone.load, seen.load) <= BUSY:
        judge("one slow browser: memory", grown, at_most=64, unit="MB")
        judge_ratio("one slow browser: rate of the others", seen.hz / alone.hz, at_least=0.85)


def _watch_many(server: Server, cell: Cell, browsers: int, window_s: float) -> Seen:
    """What browsers get that read as fast as they can."""
    job = replace(_job(server, cell), browsers=browsers // cell.processes)
    with ExitStack() as stack:
        heard = [stack.enter_context(_browsers(job)) for _ in range(cell.processes)]
        return _window(server, heard, cell, window_s)


def _memory_bytes(pid: int) -> int:
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * _PAGE_BYTES


@contextmanager
def _studio(endpoint: str, scratch: Path) -> Generator[Server]:
    words = ["demo", "--connect", endpoint, "--router", "off"]
    with running_studio(words, scratch / "data") as studio, studio.client() as client:
        client.post(
            "/api/commands", json={"type": "connect_wire"}, headers={"origin": studio.origin}
        ).raise_for_status()
        cookie = "; ".join(f"{name}={one}" for name, one in client.cookies.items())
        headers = f"Origin: {studio.origin}\r\nCookie: {cookie}\r\n"
        yield Server(Job("studio", studio.port, 0, headers=headers), studio.pid)


@contextmanager
def _other(kind: str, zenoh_port: int) -> Generator[Server]:
    with _process(data_server.__name__, kind, zenoh_port) as process:
        job = Job(kind, int(_line(process).split()[1]), 0)
        if kind == "foxglove":
            protocol = "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"
            job = replace(job, path="/", headers=protocol)
        yield Server(job, process.pid)


@contextmanager
def _publishing(zenoh_port: int, cell: Cell) -> Generator[None]:
    words = (zenoh_port, cell.rate_hz, cell.size, cell.topics)
    with _process(data_server.__name__, "publish", *words) as process:
        assert _line(process) == "port 0"
        yield


@contextmanager
def _browsers(job: Job) -> Generator[subprocess.Popen[str]]:
    with _process(data_browsers.__name__, noise=None) as process:
        _order(process, json.dumps(asdict(job)))
        assert _line(process) == "ready"
        yield process


@contextmanager
def _process(
    module: str, *words: object, noise: int | None = subprocess.DEVNULL
) -> Generator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, "-m", module, *map(str, words)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=noise,  # servers complain of browsers that leave
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout):
            with suppress(BrokenPipeError):
                cast("IO[str]", pipe).close()


def _order(process: subprocess.Popen[str], line: str) -> None:
    pipe = cast("IO[str]", process.stdin)
    pipe.write(line + "\n")
    pipe.flush()


def _line(process: subprocess.Popen[str]) -> str:
    return cast("IO[str]", process.stdout).readline().strip()
