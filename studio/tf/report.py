"""FrameReport: what is to be said of a frame: its parent, who tells of it, how often, how old."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from studio.tf.forest import NONE

if TYPE_CHECKING:
    from studio.tf.arrivals import Arrivals
    from studio.tf.forest import Forest
    from studio.tf.histories import Histories


@dataclass(frozen=True, slots=True)
class FrameReport:
    """One frame.

    Attributes:
        frame: Its name.
        parent: None for a root.
        root: What its tree hangs on.
        publishers: Who tells of it; the one of the newest transform first.
        static: Whether its transform holds at all times.
        rate_hz: How often it comes; 0 when that is not known yet.
        age_s: How long it has not come; None for a root.
        oldest_ns: The first stamp from which it is known.
        newest_ns: The stamp of the newest.
        state: Broken when nothing connects it with the fixed frame, stale when it has been silent
            for long, else fresh.
        behind: The nearest stale frame above it, if one is; its own transform may be fresh.
    """

    frame: str
    parent: str | None
    root: str
    publishers: tuple[str, ...]
    static: bool
    rate_hz: float
    age_s: float | None
    oldest_ns: int
    newest_ns: int
    state: Literal["fresh", "stale", "broken"]
    behind: str | None


def report_of(
    forest: Forest, histories: Histories, arrivals: Arrivals, fixed: str, now_ns: int
) -> list[FrameReport]:
    """Report all frames in the order of the alphabet."""
    reporting = _Reporting(forest, histories, arrivals, now_ns)
    number = forest.number(fixed)
    fixed_root = NONE if number is None else forest.root(number)
    rows = [reporting.row(number, fixed_root) for number in forest.numbers()]
    return sorted(rows, key=lambda row: row.frame)


def _root(name: str, *, is_broken: bool) -> FrameReport:
    return FrameReport(
        name,
        parent=None,
        root=name,
        publishers=(),
        static=False,
        rate_hz=0.0,
        age_s=None,
        oldest_ns=0,
        newest_ns=0,
        state="broken" if is_broken else "fresh",
        behind=None,
    )


class _Edge(NamedTuple):
    static: bool
    age_s: float
    oldest_ns: int
    newest_ns: int
    is_stale: bool


class _Reporting:
    """One report; what is known of the frames above one is looked up once."""

    def __init__(
        self, forest: Forest, histories: Histories, arrivals: Arrivals, now_ns: int
    ) -> None:
        self._forest, self._histories, self._arrivals = forest, histories, arrivals
        self._now_ns = now_ns
        self._edges = self._edges_now()
        self._above: dict[int, tuple[int, int]] = {}
        """Of each frame: its root, and the nearest stale frame from itself upwards."""

    def row(self, number: int, fixed_root: int) -> FrameReport:
        """What is to be said of one."""
        forest, name = self._forest, self._forest.names[number]
        root, _ = self._upwards(number)
        is_broken = root != fixed_root
        edge = self._edges.get(number)
        if edge is None:
            return _root(name, is_broken=is_broken)
        parent = forest.parents[number]
        behind = self._upwards(parent)[1]
        return FrameReport(
            name,
            forest.names[parent],
            forest.names[root],
            self._arrivals.publishers_of(number, self._now_ns),
            edge.static,
            self._arrivals.rate_hz(number, self._now_ns),
            edge.age_s,
            edge.oldest_ns,
            edge.newest_ns,
            "broken" if is_broken else "stale" if edge.is_stale else "fresh",
            None if behind == NONE else forest.names[behind],
        )

    def _edges_now(self) -> dict[int, _Edge]:
        """What there is to say of each frame that hangs on one."""
        numbers = [one for one in self._forest.numbers() if self._forest.parents[one] != NONE]
        at = np.array(numbers, np.int64)
        columns = (
            self._histories.is_static(at).tolist(),
            self._arrivals.ages_s(at, self._now_ns).tolist(),
            self._histories.oldest_ns(at).tolist(),
            self._histories.newest_ns(at).tolist(),
        )
        return {
            number: _Edge(*row, not row[0] and self._arrivals.is_stale(number, self._now_ns))
            for number, row in zip(numbers, zip(*columns, strict=True), strict=True)
        }

    def _upwards(self, number: int) -> tuple[int, int]:
        way: list[int] = []
        while number not in self._above and self._forest.parents[number] != NONE:
            way.append(number)
            number = self._forest.parents[number]
        found = self._above.setdefault(number, (number, NONE))
        for one in reversed(way):
            found = found[0], one if self._edges[one].is_stale else found[1]
            self._above[one] = found
        return found
