"""A moving robot seen by 1, 30 and 200 viewers, beside stock viser with as many moving links.

Viewers are raw websockets that read and throw away; they share the machine with both servers.
"""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import tempfile
import time
from contextlib import AsyncExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from tests.benchmarks import stock_viser
from tests.benchmarks.edit_to_websocket import Lane
from tests.benchmarks.report import judge_ratio, say
from tests.support.server import RunningStudio, running_studio

if TYPE_CHECKING:
    from collections.abc import Generator

VIEWERS = (1, 30, 200)
WINDOW_S = 4.0
_SETTLE_S = 1.0
_PROTOCOL = Subprotocol("viser-v1.1.1")
_MOVING_LINKS = 20
"""Links of the rover that a swing of all its joints moves, about."""


@dataclass(frozen=True)
class Server:
    """Where to look at a moving robot."""

    name: str
    url: str
    pid: int
    headers: dict[str, str]
    origin: str


@dataclass(frozen=True)
class Seen:
    """What viewers got."""

    frames_per_s: float
    """Of the viewer in the middle."""
    cpu: float
    """Share of one core that the server took."""
    megabytes_per_s: float


def run() -> None:
    """Measure both servers in turn for each number of viewers."""
    with tempfile.TemporaryDirectory() as scratch, _ours(Path(scratch)) as ours, _stock() as stock:
        for viewers in VIEWERS:
            _compare(ours, stock, viewers)


def _compare(ours: Server, stock: Server, viewers: int) -> None:
    mine, theirs = asyncio.run(_watch(ours, viewers)), asyncio.run(_watch(stock, viewers))
    for server, seen in ((ours, mine), (stock, theirs)):
        say(f"{viewers:>4} viewers, {server.name:<12}{_figures(seen)}")
    cost = (theirs.cpu / theirs.frames_per_s) / (mine.cpu / mine.frames_per_s)
    say(f"      a frame to all costs stock {cost:.1f} times as much")
    if viewers == VIEWERS[-1]:
        ratio = mine.frames_per_s / theirs.frames_per_s
        judge_ratio(f"{viewers} viewers: frames against stock viser", ratio, at_least=3)


def _figures(seen: Seen) -> str:
    rate, size = seen.frames_per_s, seen.megabytes_per_s
    return f"{rate:6.1f} Hz   {seen.cpu:6.1%} of a core   {size:6.2f} MB/s"


@contextmanager
def _ours(scratch: Path) -> Generator[Server]:
    with running_studio(["demo"], scratch / "data") as studio:
        lane = Lane(studio)
        lane.send("animate_joints", running=True)
        lane.close()
        yield Server(
            "the studio",
            f"ws://127.0.0.1:{studio.port}/d/{lane.document}/viser",
            studio.pid,
            _cookie(studio),
            studio.origin,
        )


def _cookie(studio: RunningStudio) -> dict[str, str]:
    with studio.client() as client:
        return {"Cookie": "; ".join(f"{name}={one}" for name, one in client.cookies.items())}


@contextmanager
def _stock() -> Generator[Server]:
    process = subprocess.Popen(
        [sys.executable, "-m", stock_viser.__name__, str(_MOVING_LINKS)],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        said = iter(process.stdout.readline, "")
        port = next(int(line.split()[1]) for line in said if line.startswith("port "))
        yield Server("stock viser", f"ws://127.0.0.1:{port}", process.pid, {}, "http://127.0.0.1")
    finally:
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()


async def _watch(server: Server, viewers: int) -> Seen:
    async with AsyncExitStack() as stack:
        sockets = [await stack.enter_async_context(_connect(server)) for _ in range(viewers)]
        counts, sizes = [0] * viewers, [0] * viewers

        async def read(number: int, socket: ClientConnection) -> None:
            async for message in socket:
                counts[number] += 1
                sizes[number] += len(message)

        tasks = [asyncio.create_task(read(*one)) for one in enumerate(sockets)]
        await asyncio.sleep(_SETTLE_S)
        begin_s, cpu_s, seen, size = (
            time.perf_counter(),
            cpu_s_of(server.pid),
            list(counts),
            sum(sizes),
        )
        await asyncio.sleep(WINDOW_S)
        took_s = time.perf_counter() - begin_s
        frames = sorted(after - before for after, before in zip(counts, seen, strict=True))
        result = Seen(
            frames[viewers // 2] / took_s,
            (cpu_s_of(server.pid) - cpu_s) / took_s,
            (sum(sizes) - size) / took_s / 1e6,
        )
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    return result


def _connect(server: Server) -> connect:
    return connect(
        server.url,
        subprotocols=[_PROTOCOL],
        additional_headers=server.headers,
        origin=Origin(server.origin),
        proxy=None,
        max_size=None,
        compression=None,
    )


def cpu_s_of(pid: int) -> float:
    """Seconds of all threads of a process so far (Linux)."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
