"""What classes by relays cost, as it is told, judged, and reckoned for more than was measured."""

from __future__ import annotations

import math
import statistics
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Final

from tests.benchmarks.classroom import middle, p95
from tests.benchmarks.report import judge, note, say

if TYPE_CHECKING:
    from collections.abc import Sequence

ADDED_MS: Final = 30.0
GROWTH: Final = 1.2
"""So many times what the studio takes with one browser at each relay it may take with all."""
_BUSY: Final = 0.8
_CROWD: Final = 10_000
_FULL: Final = 0.7
"""So much of a core or a line a relay may take: the rest is for those who come and for bursts."""
_GIGABIT_BYTES_PER_S: Final = 125e6
_MEGABYTE: Final = 1e6


@dataclass(frozen=True)
class Window:
    """What some seconds took: shares of one core, bytes per second, and bytes of memory."""

    studio: float
    relay: float
    """The mean of all relays, as in all that follows."""
    down: float
    up: float
    wire: float
    """To a relay, with all heads of TCP and below; 0: unknown."""
    machine: float
    """Share of all cores that was taken, by whoever."""
    studio_bytes: float
    relay_bytes: float


@dataclass(frozen=True)
class Rooms:
    """What one relay took with 0, 1, 2... rooms, each with one browser."""

    cpu: list[float]
    memory: list[float]

    @property
    def bytes_each(self) -> float:
        """Of memory, for one room more."""
        return (self.memory[-1] - self.memory[1]) / (len(self.memory) - 2)

    @property
    def cpu_each(self) -> float:
        """Of a core, for one room more."""
        return (self.cpu[-1] - self.cpu[1]) / (len(self.cpu) - 2)


@dataclass(frozen=True)
class Seen:
    """A class with so many relays and browsers."""

    relays: int
    viewers: int
    cost: Window
    """Medians."""
    bytes_per_s: float
    """Of one browser; 0: there were none but the sampler's."""
    hz: float
    """Arrivals on its 3D view."""
    load: float
    """What the browsers took, in cores."""
    ages: dict[str, dict[str, list[float]]]

    @classmethod
    def of(
        cls,
        relays: int,
        viewers: int,
        windows: Sequence[Window],
        loads: list[dict[str, Any]],
        ages: dict[str, dict[str, list[float]]],
    ) -> Seen:
        """Of what was measured."""
        names = [one.name for one in fields(Window)]
        cost = Window(*(statistics.median(getattr(w, name) for w in windows) for name in names))

        def mean(name: str) -> float:
            return statistics.mean(one[name] for one in loads) if loads else 0.0

        load = sum(one["cpu_s"] for one in loads)
        return cls(relays, viewers, cost, mean("bytes_per_s"), mean("hz"), load, ages)

    @property
    def is_disturbed(self) -> bool:
        """Whether the machine was so busy that ages say more about it than about the studio."""
        return self.cost.machine > _BUSY

    def tell(self) -> None:
        """One line of costs, and one of the ages of each kind."""
        cost = self.cost
        say(
            f"{self.relays} relays, {self.viewers:>3} browsers: studio {60 * cost.studio:5.1f} s "
            f"of CPU a minute and {cost.studio_bytes / _MEGABYTE:4.0f} MB, each relay "
            f"{60 * cost.relay:5.1f} s and {cost.relay_bytes / _MEGABYTE:4.0f} MB; to a relay "
            f"{cost.down / 1e3:5.1f} kB/s ({cost.wire / 1e3:5.1f} with heads), back "
            f"{cost.up / 1e3:4.1f}, to a browser {self.bytes_per_s / 1e3:5.1f} kB/s at "
            f"{self.hz:.0f} Hz; machine {cost.machine:.0%}, load {self.load:.0%}"
        )
        for kind, seen in self.ages.items():
            parts = [
                f"{name.removesuffix('_ms')} p50 {middle(ages):.1f} p95 {p95(ages):.1f} "
                f"max {max(ages):.1f} ms"
                for name, ages in seen.items()
                if ages
            ]
            if parts:
                say(f"    {kind:<6} {'; '.join(parts)}")


def judge_all(seen: Sequence[Seen], rooms: Rooms) -> None:
    """Judge what is asked, and note the rest."""
    by = {(one.relays, one.viewers): one for one in seen}
    counts = sorted({one.relays for one in seen} - {0})
    most = max(one.viewers for one in seen)
    for count in counts:
        ratio = by[count, most].cost.studio / by[count, 1].cost.studio
        what = f"{count} relays: the studio with {most} browsers, beside one at each"
        judge(what, ratio, at_most=GROWTH, unit="of it")
    for one in seen:
        if one.relays and one.ages:
            _judge_ages(one)
    _note(by, rooms, counts)


def _judge_ages(one: Seen) -> None:
    for kind, ages in one.ages.items():
        what = f"{one.relays} relays, {one.viewers} browsers: {kind}, added at p95"
        if one.is_disturbed:
            say(f"  {what}: {p95(ages['added_ms']):.1f} ms; the machine is busy: told only")
        else:
            judge(what, p95(ages["added_ms"]), at_most=ADDED_MS)


def _fullest(by: dict[tuple[int, int], Seen], relays: int) -> Seen:
    """The most browsers that were measured while the machine was not too busy, or at all."""
    found = [one for one in by.values() if one.relays == relays and one.viewers > 1]
    return max(found, key=lambda one: (not one.is_disturbed, one.viewers))


def _note(by: dict[tuple[int, int], Seen], rooms: Rooms, counts: list[int]) -> None:
    one, full, own = by[1, 1], _fullest(by, 1), _fullest(by, 0)
    viewer = (full.cost.relay - one.cost.relay) / (full.viewers - 1)
    direct = (own.cost.studio - by[0, 1].cost.studio) / (own.viewers - 1)
    relay = (by[counts[-1], 1].cost.studio - one.cost.studio) / (counts[-1] - counts[0])
    memory = (full.cost.relay_bytes - one.cost.relay_bytes) / (full.viewers - 1)
    note("a browser at a relay: CPU of the relay, a minute", f"{60e3 * viewer:.0f} ms")
    note("a browser at the studio: CPU of the studio, a minute", f"{60e3 * direct:.0f} ms")
    note("a relay more: CPU of the studio, a minute", f"{60 * relay:.2f} s")
    note("a room more: CPU of the relay, a minute", f"{60 * rooms.cpu_each:.2f} s")
    note("a room more: memory of the relay", f"{rooms.bytes_each / _MEGABYTE:.1f} MB")
    note("a browser at a relay: memory of the relay", f"{memory / 1e3:.0f} kB")
    note("the line to a relay", f"{full.cost.down / 1e3:.1f} kB/s")
    note("the line to a relay, with heads of TCP and below", f"{full.cost.wire / 1e3:.1f} kB/s")
    note("to one browser", f"{full.bytes_per_s / 1e3:.1f} kB/s")
    note("the line beside one browser", f"{full.cost.down / full.bytes_per_s:.2f} of it")
    room = one.cost.relay
    by_core = math.floor((_FULL - room) / viewer)
    by_line = math.floor(_FULL * _GIGABIT_BYTES_PER_S / full.bytes_per_s)
    note("reckoned: browsers of a relay by one core", str(by_core))
    note("reckoned: browsers of a relay by 1 Gbit/s", str(by_line))
    needed = math.ceil(_CROWD / min(by_core, by_line))
    note(f"reckoned: relays for {_CROWD:,} browsers", str(needed))
    uplink = needed * (full.cost.wire or full.cost.down) * 8 / 1e6
    note(f"reckoned: the studio's uplink for {_CROWD:,} browsers", f"{uplink:.1f} Mbit/s")
