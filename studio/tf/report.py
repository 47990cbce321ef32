"""FrameReport: what is to be said of a frame: its parent, who tells of it, how often, how old."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

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


class _Reporting:
    """One report; what is known of the frames above one is looked up once."""

    def __init__(
        self, forest: Forest, histories: Histories, arrivals: Arrivals, now_ns: int
    ) -> None:
        self._forest, self._histories, self._arrivals = forest, histories, arrivals
        self._now_ns = now_ns
        self._stale: dict[int, bool] = {}
        self._above: dict[int, tuple[int, int]] = {}
        """Of each frame: its root, and the nearest stale frame from itself upwards."""

    def row(self, number: int, fixed_root: int) -> FrameReport:
        """What is to be said of one."""
        forest, parent = self._forest, self._forest.parents[number]
        root, _ = self._upwards(number)
        behind = NONE if parent == NONE else self._upwards(parent)[1]
        is_broken = root != fixed_root
        state = "broken" if is_broken else "stale" if self._is_stale(number) else "fresh"
        at, is_root = np.array([number]), parent == NONE
        return FrameReport(
            forest.names[number],
            None if is_root else forest.names[parent],
            forest.names[root],
            () if is_root else self._arrivals.publishers_of(number, self._now_ns),
            not is_root and bool(self._histories.is_static(at)[0]),
            0.0 if is_root else self._arrivals.rate_hz(number, self._now_ns),
            None if is_root else float(self._arrivals.ages_s(at, self._now_ns)[0]),
            0 if is_root else int(self._histories.oldest_ns(at)[0]),
            0 if is_root else int(self._histories.newest_ns(at)[0]),
            state,
            None if behind == NONE else forest.names[behind],
        )

    def _upwards(self, number: int) -> tuple[int, int]:
        way: list[int] = []
        while number not in self._above and self._forest.parents[number] != NONE:
            way.append(number)
            number = self._forest.parents[number]
        found = self._above.setdefault(number, (number, NONE))
        for one in reversed(way):
            found = found[0], one if self._is_stale(one) else found[1]
            self._above[one] = found
        return found

    def _is_stale(self, number: int) -> bool:
        if number not in self._stale:
            moves = self._forest.parents[number] != NONE and not bool(
                self._histories.is_static(np.array([number]))[0]
            )
            self._stale[number] = moves and self._arrivals.is_stale(number, self._now_ns)
        return self._stale[number]
