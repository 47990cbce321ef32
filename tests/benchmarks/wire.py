"""The wire: rate, latency and processor of a topic beside bare zenoh and zenoh-ros2-sdk.

Receivers are fed by bare zenoh's publisher, publishers are heard by nobody but the router, so that
one end alone differs. Encoding and decoding, and the graph, are measured in this process.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import time
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, cast

from studio.ros.graph.graph import Graph
from tests.benchmarks import wire_codecs
from tests.benchmarks.report import judge, say
from tests.benchmarks.wire_process import WINDOW_S
from tests.support.many_topics import announce_topics, topic_named
from tests.support.wire import open_test_session, running_router

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

RATE_HZ = 5_000
RUNS = 3
ENDPOINTS = 1_000
RECEIVERS = {
    "ours": "ours, decoded messages",
    "ours-raw": "ours, bytes",
    "drain": "our drain thread alone",
    "bare": "bare zenoh, callback",
    "ring": "bare zenoh, ring every 2 ms",
    "sdk": "zenoh-ros2-sdk",
}
PUBLISHERS = {"ours": "ours", "bare": "bare zenoh", "sdk": "zenoh-ros2-sdk"}
_WARM_UP_S = 1.0
_BROKEN_LINKS_S = 30.0

Figures = dict[str, float]


def run() -> None:
    """Measure topics, codecs and the graph."""
    with running_router() as endpoint:
        port = endpoint.rpartition(":")[2]
        _receivers(port)
        _publishers(port)
    wire_codecs.run()
    _graph()


def _receivers(port: str) -> None:
    say(f"receive 500 bytes at {RATE_HZ} Hz, one process each")
    found = _interleaved(list(RECEIVERS), lambda kind: _receive(kind, port))
    for kind, name in RECEIVERS.items():
        one = found[kind]
        delays = f"p50 {one['p50_ms']:7.2f} ms   p95 {one['p95_ms']:7.2f} ms"
        say(f"  {name:<32}{one['rate_hz']:8.0f} Hz   {one['cpu']:6.1%} of a core   {delays}")
    bare = found["bare"]["cpu"]
    judge("receive: CPU of ours over bare zenoh", found["ours"]["cpu"] / bare,
          at_most=1.5, unit="times")  # fmt: skip
    say(f"  the drain thread takes {found['drain']['cpu'] / bare:.2f} of bare zenoh's CPU")


def _publishers(port: str) -> None:
    say(f"publish 500 bytes at {RATE_HZ} Hz, one process each")
    found = _interleaved(list(PUBLISHERS), lambda kind: _publish(kind, port))
    for kind, name in PUBLISHERS.items():
        one = found[kind]
        say(f"  {name:<32}{one['rate_hz']:8.0f} Hz   {one['cpu']:6.1%} of a core")
    judge("publish: CPU of ours over bare zenoh", found["ours"]["cpu"] / found["bare"]["cpu"],
          at_most=1.5, unit="times")  # fmt: skip


def _graph() -> None:
    live_ms, late_ms = zip(*(_appear() for _ in range(RUNS)), strict=True)
    say(f"{ENDPOINTS} endpoints: seen after {statistics.median(live_ms):.0f} ms by one who watches,"
        f" {statistics.median(late_ms):.0f} ms by one who comes")  # fmt: skip
    judge(f"{ENDPOINTS} endpoints in the graph", statistics.median(live_ms), at_most=1000)
    judge(f"{ENDPOINTS} endpoints for who comes late", statistics.median(late_ms), at_most=1000)


def _appear() -> tuple[float, float]:
    """Give the milliseconds from the first declaration, and from a late look, to the last."""
    last = topic_named(ENDPOINTS - 1)
    with (
        running_router() as endpoint,
        open_test_session(endpoint) as watching,
        open_test_session(endpoint) as busy,
        Graph(watching) as graph,
    ):
        begin_s = time.perf_counter()
        kept = announce_topics(busy, ENDPOINTS)
        assert graph.wait_for(lambda: bool(graph.publishers(last)), _BROKEN_LINKS_S)
        live_ms = (time.perf_counter() - begin_s) * 1000
        begin_s = time.perf_counter()
        with Graph(watching) as late:
            assert late.settle(_BROKEN_LINKS_S)
            late_ms = (time.perf_counter() - begin_s) * 1000
            assert len(late.topics()) == ENDPOINTS == len(kept) - 1
    return live_ms, late_ms


def _interleaved(kinds: list[str], measure: Callable[[str], Figures]) -> dict[str, Figures]:
    """Measure each in turn, several times over; give the middle of each figure."""
    runs: dict[str, list[Figures]] = {kind: [] for kind in kinds}
    for _ in range(RUNS):
        for kind in kinds:
            runs[kind].append(measure(kind))
    return {
        kind: {name: statistics.median(one[name] for one in found) for name in found[0]}
        for kind, found in runs.items()
    }


def _receive(kind: str, port: str) -> Figures:
    with _end("receive", kind, port) as receiver, _end("publish", "bare", port):
        return json.loads(_line(receiver))


def _publish(kind: str, port: str) -> Figures:
    with _end("receive", "ring", port), _end("publish", kind, port) as publisher:
        time.sleep(_WARM_UP_S + WINDOW_S)
        assert publisher.stdin is not None
        publisher.stdin.close()
        return json.loads(_line(publisher))


@contextmanager
def _end(role: str, kind: str, port: str) -> Generator[subprocess.Popen[str]]:
    words = [sys.executable, "-m", "tests.benchmarks.wire_process", role, kind, port, str(RATE_HZ)]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        assert _line(process) == "ready"
        yield process
    finally:
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                pipe.close()


def _line(process: subprocess.Popen[str]) -> str:
    return cast("IO[str]", process.stdout).readline().strip()
