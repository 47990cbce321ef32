"""A robot on DDS beside one on rmw_zenoh: delays, processor and losses of the same messages.

Robot, router or bridge, and studio are processes in one network namespace. Nothing goes by shared
memory, for robots are other machines. DDS is given larger buffers of its sockets, as ROS's manual
of tuning has it for pictures, and once those that it has by itself, which hold less than a picture.
The bridge is a build for tests, not made for speed: what it takes, and how much later samples come,
is more than with a released one; the studio's part is not.
"""

from __future__ import annotations

import os
import statistics
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pytest

from tests.benchmarks.dds_process import LOADS
from tests.benchmarks.report import note, say
from tests.support.dds_bridge import dds_network
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.support.dds_bridge import DdsNetwork
    from tests.support.ros2_peer import RealNode, RealNodes

RUNS: Final = 5
WAYS: Final = {
    "zenoh": "rmw_zenoh, a router",
    "dds-router": "DDS, the bridge at a router",
    "dds": "DDS, the bridge is the router",
    "dds-plain": "DDS, the same, plain buffers",
}
_COMPARED: Final = {"studio_us": "CPU of the studio a sample", "p50_ms": "p50", "p95_ms": "p95"}
_ENDPOINT: Final = "tcp/127.0.0.1:7447"
"""In a namespace of its own, where nobody else has it."""
_MODULE: Final = "tests.benchmarks.dds_process"
_WARM_UP_S, _WINDOW_S, _REST_S = 1.0, 3.0, 15.0
_BUFFERS: Final = '<Internal><SocketReceiveBufferSize max="16MB"/></Internal>'
_BUFFER_MOST: Final = Path("/proc/sys/net/core/rmem_max")
_NODES, _ENDS = 30, 5
"""So many nodes have so many publishers and as many subscriptions each: 300 ends."""
_TICKS: Final = os.sysconf("SC_CLK_TCK")

Figures = dict[str, float]


def run() -> None:
    """Measure ways in turn, what a bridge costs at rest, and what looking for one costs."""
    try:
        with dds_network():
            pass
    except pytest.skip.Exception as error:
        say(f"skipped: {error}")
        return
    say("The bridge is a build for tests, not for measuring speed: compare what the studio takes.")
    say(f"Buffers of sockets may have {int(_BUFFER_MOST.read_text()) / 1e6:.1f} MB here.")
    _samples()
    _rest()
    _publications()


def _samples() -> None:
    rounds: dict[tuple[str, str], list[Figures]] = {}
    for _ in range(RUNS):
        for way in WAYS:
            for load, figures in _measured(way).items():
                rounds.setdefault((load, way), []).append(figures)
    for load in LOADS:
        _say_load(load, {way: rounds[load, way] for way in WAYS})


def _say_load(load: str, rounds: dict[str, list[Figures]]) -> None:
    one = LOADS[load]
    say(f"{load}: {one.type_name}, {len(one.cdr())} bytes at {one.rate_hz:g} Hz, medians of {RUNS}")
    for way, name in WAYS.items():
        middle = {key: statistics.median(it[key] for it in rounds[way]) for key in rounds[way][0]}
        say(
            f"  {name:<32}p50 {middle['p50_ms']:7.2f} ms   p95 {middle['p95_ms']:7.2f} ms   "
            f"p99 {middle['p99_ms']:7.2f} ms   at most {middle['max_ms']:7.2f} ms   "
            f"{middle['hz']:6.1f} Hz   lost {sum(it['lost'] for it in rounds[way]):.0f} of "
            f"{sum(it['lost'] + it['came'] for it in rounds[way]):.0f}"
        )
        say(
            f"  {'':<32}CPU: studio {middle['studio']:6.1%}, "
            f"{middle['studio_us']:4.0f} us a sample   "
            f"router {middle['router']:6.1%}   "
            f"bridge {middle['bridge']:6.1%}   robot {middle['robot']:6.1%}   "
            f"{middle['a_read']:.1f} samples a read"
        )
    for way in [one for one in WAYS if one != "zenoh"]:
        name = f"{load}: {WAYS[way]}"
        for key, what in _COMPARED.items():
            _note_ratio(f"{name} over rmw_zenoh, {what}", rounds, way, key)
        lost, came = (sum(it[key] for it in rounds[way]) for key in ("lost", "came"))
        note(f"{name}: lost", f"{lost / max(1, lost + came):.1%}")


def _note_ratio(what: str, rounds: dict[str, list[Figures]], way: str, key: str) -> None:
    """Note the middle of the rounds' ratios, and say how far they lie apart."""
    pairs = zip(rounds[way], rounds["zenoh"], strict=True)
    ratios = sorted(ours[key] / other[key] for ours, other in pairs if other[key])
    if ratios:
        note(what, f"{statistics.median(ratios):.2f} times")
        say(f"          of single rounds {ratios[0]:.2f} to {ratios[-1]:.2f}")


def _measured(way: str) -> dict[str, Figures]:
    """Measure all loads over one way."""
    with dds_network("" if way == "dds-plain" else _BUFFERS) as network:
        middle = _middle(network, way)
        robot = network.nodes(_MODULE, "zenoh" if way == "zenoh" else "dds", _ENDPOINT)
        studio = network.nodes(_MODULE, "studio", _ENDPOINT)
        running = {**middle, "robot": robot, "studio": studio}
        return {load: _load(load, robot, studio, running) for load in LOADS}


def _middle(network: DdsNetwork, way: str) -> dict[str, RealNode]:
    """What is between robot and studio."""
    running: dict[str, RealNode] = {}
    if way in {"zenoh", "dds-router"}:
        running["router"] = network.nodes(_MODULE, "router", _ENDPOINT)
    if way in {"dds", "dds-plain"}:
        running["bridge"] = network.bridge(options=("-l", _ENDPOINT))
    elif way == "dds-router":
        running["bridge"] = network.bridge(options=("-e", _ENDPOINT))
    return running


def _load(load: str, robot: RealNodes, studio: RealNodes, running: dict[str, RealNode]) -> Figures:
    studio.ask("subscribe", load=load)
    robot.ask("send", load=load)
    wait_until(f"{load} comes", lambda: studio.ask("count") > 0)
    time.sleep(_WARM_UP_S)
    studio.ask("begin")
    before, begin_s = _cpu_s(running), time.monotonic()
    time.sleep(_WINDOW_S)
    after, span_s = _cpu_s(running), time.monotonic() - begin_s
    figures = studio.ask("figures")
    robot.ask("stop")
    taken = {name: (after[name] - before[name]) / span_s for name in before}
    return {
        "router": 0.0,
        "bridge": 0.0,
        **figures,
        **taken,
        "hz": figures["came"] / span_s,
        "studio_us": taken["studio"] * span_s * 1e6 / max(1, figures["came"]),
    }


def _cpu_s(running: dict[str, RealNode]) -> Figures:
    """Seconds of processor that each took so far, all threads."""
    return {name: _taken_s(one.process.pid) for name, one in running.items()}


def _taken_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / _TICKS


def _rest() -> None:
    """A studio and a bridge with many ends of which nothing comes."""
    count = 2 * _NODES * _ENDS
    found = {way: [_at_rest(way, count) for _ in range(3)] for way in ("zenoh", "dds")}
    say(f"{count} ends at rest, {_NODES} nodes")
    for way, runs in found.items():
        middle = {key: statistics.median(it[key] for it in runs) for key in runs[0]}
        say(
            f"  {WAYS[way]:<32}in the graph {middle['live_s']:5.2f} s after they began, "
            f"{middle['late_s']:5.2f} s for who comes late   CPU: studio {middle['studio']:6.2%}   "
            f"router {middle['router']:6.2%}   bridge {middle['bridge']:6.2%}, "
            f"{middle['alone']:6.2%} without a studio"
        )
        note(f"{count} ends, {WAYS[way]}: in the graph", f"{middle['live_s']:.2f} s")
        note(f"{count} ends, {WAYS[way]}: for who comes late", f"{middle['late_s']:.2f} s")
        note(f"{count} ends, {WAYS[way]}: CPU of the studio", f"{middle['studio']:.2%}")


def _at_rest(way: str, count: int) -> Figures:
    with dds_network() as network:
        running = _middle(network, way)
        robot = network.nodes(_MODULE, "zenoh" if way == "zenoh" else "dds", _ENDPOINT)
        first = network.nodes(_MODULE, "studio", _ENDPOINT)
        begin_s = time.monotonic()
        robot.ask("many", nodes=_NODES, ends=_ENDS)
        live_s = first.ask("wait_ends", count=count) - begin_s
        first.kill()
        time.sleep(_WARM_UP_S)
        alone = _share(lambda: running)
        begin_s = time.monotonic()
        late = network.nodes(_MODULE, "studio", _ENDPOINT)
        told = late.ask("wait_ends", count=count)
        time.sleep(_WARM_UP_S)
        shares = _share(lambda: {**running, "studio": late})
        return {
            "router": 0.0,
            "bridge": 0.0,
            **shares,
            "alone": alone.get("bridge", alone.get("router", 0.0)),
            "live_s": live_s,
            "late_s": told - late.wait_said("ready")["at_s"],
        }


def _share(running: Callable[[], dict[str, RealNode]]) -> Figures:
    """What each takes of a core for a while."""
    before = _cpu_s(running())
    time.sleep(_REST_S)
    after = _cpu_s(running())
    return {name: (after[name] - before[name]) / _REST_S for name in before}


def _publications() -> None:
    """A publisher's look at its half for bridges, where none is there and where one is."""
    say("a publication that nobody hears, medians of interleaved rounds")
    for way in ("zenoh", "dds-router"):
        with dds_network() as network:
            _middle(network, way)
            studio = network.nodes(_MODULE, "studio", _ENDPOINT)
            if way != "zenoh":
                wait_until("the bridge is met", lambda studio=studio: studio.ask("is_bridged"))
            found = studio.ask("publish_costs")
        where = "no bridge there" if way == "zenoh" else "a bridge there"
        added_ns = found["with"] - found["without"]
        say(f"  {where:<32}{found['without']:8.0f} ns without the half, {found['with']:8.0f} with")
        note(f"a publication, {where}: the half for bridges adds", f"{added_ns:.0f} ns")
