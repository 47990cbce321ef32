"""The data lane beside foxglove-sdk's server and a plain FastAPI loop: one topic, many browsers.

All hear the same topic over Zenoh from a process that publishes it. Browsers are sockets that
count bytes; a row counts only while they take less than 0.9 of a core. Where foxglove-sdk is not
installed, it is left out.
"""

from __future__ import annotations

import asyncio
import base64
import importlib.util
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.benchmarks import data_server
from tests.benchmarks.fan_out import cpu_s_of
from tests.benchmarks.report import judge, say
from tests.support.server import running_studio
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator

CELLS: Final = (
    (500, 1_000, 10, 0.6),
    (500, 1_000, 30, 0.6),
    (5_000, 50, 50, 0.85),
    (500, 5_000, 10, 0.3),
)
"""Bytes of a message, how many in a second, how many browsers, and what part of the others' CPU."""
OVER_EMPTY: Final = 1.5
"""Of a callback that does nothing, with 5,000 messages in a second."""
RUNS: Final = 3
WINDOW_S: Final = 3.0
_SETTLE_S: Final = 1.0
_BUSY: Final = 0.9
_WISH: Final = json.dumps({"type": "hear", "wish": 1, "topic": data_server.TOPIC, "mode": "every"})
_SUBSCRIBE: Final = json.dumps({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 1}]})


@dataclass(frozen=True)
class Server:
    """Where to hear, as whom, and what is said first."""

    name: str
    port: int
    pid: int
    path: str = "/data"
    headers: str = ""
    first: str = ""


@dataclass(frozen=True)
class Seen:
    """What one run showed."""

    cpu: float
    """Of the server, in cores."""
    messages_per_s: float
    """Of one browser, in the middle."""
    load: float
    """What the browsers took, in cores."""


class Browser(asyncio.Protocol):
    """Shakes hands, says what it hears, and counts the bytes that come."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._shaken = False
        self.bytes = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Ask for a websocket."""
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        key = base64.b64encode(os.urandom(16)).decode()
        server = self._server
        transport.write(
            (
                f"GET {server.path} HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n"
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                f"Sec-WebSocket-Key: {key}\r\n{server.headers}\r\n"
            ).encode()
        )

    def data_received(self, data: bytes) -> None:
        """Count, once hands are shaken."""
        self.bytes += len(data)
        if not self._shaken and b"\r\n\r\n" in data:
            assert b" 101 " in data, data[:200]
            self._shaken = True
            if self._server.first:
                self._transport.write(_text_frame(self._server.first.encode()))

    def close(self) -> None:
        """Leave."""
        self._transport.abort()


def _text_frame(payload: bytes) -> bytes:
    """A short text from a browser, masked with zeros."""
    assert len(payload) < 126
    return bytes((0x81, 0x80 | len(payload), 0, 0, 0, 0)) + payload


def run() -> None:
    """Measure every cell with every server in turn, again and again."""
    with running_router() as endpoint, tempfile.TemporaryDirectory() as scratch:
        zenoh_port = int(endpoint.rpartition(":")[2])
        with ExitStack() as stack:
            servers = [stack.enter_context(_studio(endpoint, Path(scratch)))]
            kinds = ["naive", "empty"]
            if importlib.util.find_spec("foxglove"):
                kinds.append("foxglove")
            else:
                say("  foxglove-sdk is not installed: beside a plain FastAPI loop alone")
            servers += [stack.enter_context(_other(kind, zenoh_port)) for kind in kinds]
            for cell in CELLS:
                _cell(servers, zenoh_port, cell)


def _cell(servers: list[Server], zenoh_port: int, cell: tuple[int, int, int, float]) -> None:
    size, rate_hz, browsers, share = cell
    say(f"  {size} bytes at {rate_hz} Hz to {browsers} browsers")
    found: dict[str, list[Seen]] = {server.name: [] for server in servers}
    with _process("publish", zenoh_port, rate_hz, size):
        for _ in range(RUNS):
            for server in servers:
                heard_by = 0 if server.name == "empty" else browsers
                found[server.name].append(asyncio.run(_watch(server, heard_by, size)))
    middle = {name: _middle(seen) for name, seen in found.items()}
    for name, seen in middle.items():
        say(
            f"    {name:<10}{seen.cpu:7.1%} of a core   {seen.messages_per_s:8.0f} of "
            f"{rate_hz} Hz   load {seen.load:5.0%}"
        )
    _judge(middle, f"{size} B at {rate_hz} Hz to {browsers}", share)
    if rate_hz == CELLS[-1][1]:
        over = middle["studio"].cpu / middle["empty"].cpu
        judge("CPU over that of an empty callback", over, at_most=OVER_EMPTY, unit="times")


def _middle(runs: list[Seen]) -> Seen:
    return Seen(
        statistics.median(one.cpu for one in runs),
        statistics.median(one.messages_per_s for one in runs),
        max(one.load for one in runs),
    )


def _judge(middle: dict[str, Seen], cell: str, share: float) -> None:
    ours = middle["studio"]
    for name in ("foxglove", "naive"):
        other = middle.get(name)
        if other is None:
            continue
        if max(other.load, ours.load) > _BUSY:
            say(f"    against {name}: not measurable here")
        else:
            what = f"{cell}: CPU of ours over {name}"
            judge(what, ours.cpu / other.cpu, at_most=share, unit="times")


async def _watch(server: Server, browsers: int, size: int) -> Seen:
    loop = asyncio.get_running_loop()
    opened = [
        (await loop.create_connection(lambda: Browser(server), "127.0.0.1", server.port))[1]
        for _ in range(browsers)
    ]
    await asyncio.sleep(_SETTLE_S)
    before = [one.bytes for one in opened]
    begin_s, cpu_s, load_s = time.perf_counter(), cpu_s_of(server.pid), time.process_time()
    await asyncio.sleep(WINDOW_S)
    took_s = time.perf_counter() - begin_s
    came = sorted(one.bytes - was for one, was in zip(opened, before, strict=True))
    seen = Seen(
        (cpu_s_of(server.pid) - cpu_s) / took_s,
        came[len(came) // 2] / (size + 13) / took_s if came else 0.0,
        (time.process_time() - load_s) / took_s,
    )
    for one in opened:
        one.close()
    return seen


@contextmanager
def _studio(endpoint: str, scratch: Path) -> Generator[Server]:
    words = ["demo", "--connect", endpoint, "--router", "off"]
    with running_studio(words, scratch / "data") as studio, studio.client() as client:
        client.post(
            "/api/commands", json={"type": "connect_wire"}, headers={"origin": studio.origin}
        ).raise_for_status()
        cookie = "; ".join(f"{name}={one}" for name, one in client.cookies.items())
        headers = f"Origin: {studio.origin}\r\nCookie: {cookie}\r\n"
        yield Server("studio", studio.port, studio.pid, headers=headers, first=_WISH)


@contextmanager
def _other(kind: str, zenoh_port: int) -> Generator[Server]:
    with _process(kind, zenoh_port, 0) as (pid, port):
        if kind == "foxglove":
            protocol = "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"
            yield Server(kind, port, pid, "/", protocol, _SUBSCRIBE)
        else:
            yield Server(kind, port, pid)


@contextmanager
def _process(*words: object) -> Generator[tuple[int, int]]:
    process = subprocess.Popen(
        [sys.executable, "-m", data_server.__name__, *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,  # they complain of browsers that leave
        text=True,
    )
    try:
        assert process.stdout is not None
        said = iter(process.stdout.readline, "")
        yield process.pid, next(int(line.split()[1]) for line in said if line.startswith("port "))
    finally:
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()
