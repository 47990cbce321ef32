"""Markers: milliseconds from the bytes of an array to its Drawing, and when nothing is new."""

from __future__ import annotations

from dataclasses import replace
from itertools import cycle
from typing import TYPE_CHECKING, Any

from studio.displays.display import Received
from studio.displays.markers.display import MarkerArrayDisplay
from studio.displays.markers.kinds import Kind
from studio.ros.columns.markers import MarkerCodec
from tests.benchmarks.report import Timings, judge, say
from tests.support.markers import TYPES, array_of, marker

if TYPE_CHECKING:
    from collections.abc import Iterable

COUNT = 2000
RUNS = 40
_MOVES = 10
_SOLIDS = (Kind.ARROW, Kind.CUBE, Kind.SPHERE, Kind.CYLINDER)
_STRIP = [(float(each), 0.0, 0.0) for each in range(10)]


def run() -> None:
    """Measure arrays whose markers move with each message, then one that says the same again."""
    say(f"{'markers: take in and draw':<44}{'median':>10}{'p95':>10}{'decode':>10}{'share':>8}")
    solids = [marker(_SOLIDS[each % 4], each, at=(each / 2, 0.0, 0.0)) for each in range(COUNT)]
    moved = _measure("MarkerArray, 2,000 solids, all moved", solids)
    strips = [marker(Kind.LINE_STRIP, each, points=_STRIP) for each in range(COUNT)]
    _measure("MarkerArray, 2,000 line strips of 10, all moved", strips)
    texts = [marker(Kind.TEXT, each, text=f"text {each}") for each in range(COUNT)]
    _measure("MarkerArray, 2,000 texts, all moved", texts)
    many = [(float(each % 100), float(each // 100), 0.0) for each in range(100_000)]
    cubes = [marker(Kind.CUBE_LIST, points=many, scale=(0.1, 0.1, 0.1))]
    _measure("MarkerArray, a list of 100,000 cubes, moved", cubes)
    same = _measure("MarkerArray, 2,000 solids, as they were", solids, moves=1)
    idle = _idle(solids)
    say(f"  {'draw, no message since':<42}{idle:10.4f}")
    judge("MarkerArray(2,000): decode, take in and draw", moved, at_most=10)
    judge("MarkerArray(2,000), as they were: decode and draw", same, at_most=10)
    judge("MarkerArray(2,000): draw when nothing came", idle, at_most=0.05)


def _measure(title: str, markers: list[Any], moves: int = _MOVES) -> float:
    """Take and draw messages one after another; the median in ms."""
    display, codec = MarkerArrayDisplay(TYPES), MarkerCodec()
    messages = cycle(moved(array_of(*markers), moves))
    display.take(next(messages))
    display.draw(0)
    whole, decode = Timings(title), Timings("decode")
    for _, message in zip(range(RUNS), messages, strict=False):
        with whole.measure():
            display.take(message)
            display.draw(0)
        with decode.measure():
            codec.decode(message.cdr)
    share = decode.median_ms / whole.median_ms
    figures = f"{whole.median_ms:10.3f}{whole.p95_ms:10.3f}{decode.median_ms:10.3f}{share:8.1%}"
    say(f"  {title:<42}{figures}")
    return whole.median_ms


def moved(first: Received, moves: int) -> Iterable[Received]:
    """Yield the same markers again, each time a step further."""
    codec = MarkerCodec()
    columns = codec.decode(first.cdr)
    for move in range(moves):
        stamps_ns = columns.stamps_ns + move
        moved = replace(columns, positions=columns.positions + move, stamps_ns=stamps_ns)
        yield Received(first.type_name, bytes(codec.encode(moved)), 0)


def _idle(markers: list[Any]) -> float:
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(*markers))
    display.draw(0)
    idle = Timings("idle")
    for now_ns in range(RUNS):
        with idle.measure():
            display.draw(now_ns)
    return idle.median_ms
