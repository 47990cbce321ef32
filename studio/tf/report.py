"""FrameReport: what is to be said of a frame: its parent, who tells of it, how often, how old."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from studio.tf.forest import NONE

if TYPE_CHECKING:
    from studio.tf.arrivals import Arrivals
    from studio.tf.columns import Flags, Numbers
    from studio.tf.histories import Histories
    from studio.tf.shape import ForestShape


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


class Reporting:
    """What is known of frames at one time: gathered in one go, put into words at leisure.

    Whoever makes it holds the buffer's lock; `reports` needs none.

    Args:
        shape: Of the forest.
        histories: Of its frames.
        arrivals: Of its frames.
        fixed: What is not connected with it is broken.
        now_ns: By the clock of the arrivals.
        most: So many are told of, the first of the alphabet; None: all.
    """

    def __init__(
        self,
        shape: ForestShape,
        histories: Histories,
        arrivals: Arrivals,
        fixed: str,
        now_ns: int,
        most: int | None,
    ) -> None:
        self._shape, structure = shape, shape.structure
        chosen = shape.alphabetical[:most]
        self._chosen: list[int] = chosen.tolist()
        fixed_row = shape.rows.get(fixed)
        fixed_root = NONE if fixed_row is None else structure.roots[fixed_row]
        self._broken: list[bool] = (structure.roots != fixed_root).tolist()
        hung = chosen[structure.parents[chosen] != NONE]
        told = _told_of(shape.numbers[hung], histories, arrivals, now_ns)
        self._told = dict(zip(hung.tolist(), told, strict=True))
        self._stale = _stale(shape, histories, arrivals, now_ns)

    def reports(self) -> list[FrameReport]:
        """Of each frame, in the order of the alphabet."""
        structure = self._shape.structure
        ways = _Ways(
            structure.parents.tolist(),
            structure.roots.tolist(),
            self._stale.tolist(),
            structure.first_above(self._stale).tolist(),
        )
        return [self._report(row, ways) for row in self._chosen]

    def _report(self, row: int, ways: _Ways) -> FrameReport:
        names, told = self._shape.names, self._told.get(row)
        if told is None:
            return _root(names[row], is_broken=self._broken[row])
        parent = ways.parents[row]
        behind = ways.first_stale[parent]
        return FrameReport(
            names[row],
            names[parent],
            names[ways.roots[row]],
            *told,
            _state(is_broken=self._broken[row], is_stale=ways.stale[row]),
            None if behind == NONE else names[behind],
        )


class _Told(NamedTuple):
    """What is known of a frame that hangs on one, as in a FrameReport."""

    publishers: tuple[str, ...]
    static: bool
    rate_hz: float
    age_s: float
    oldest_ns: int
    newest_ns: int


class _Ways(NamedTuple):
    """Of all rows; `first_stale` is the nearest stale frame from each upwards, or NONE."""

    parents: list[int]
    roots: list[int]
    stale: list[bool]
    first_stale: list[int]


def _told_of(frames: Numbers, histories: Histories, arrivals: Arrivals, now_ns: int) -> list[_Told]:
    publishers = [arrivals.publishers_of(frame, now_ns) for frame in frames.tolist()]
    columns = (
        publishers,
        histories.is_static(frames).tolist(),
        arrivals.rates_hz(frames, now_ns).tolist(),
        arrivals.ages_s(frames, now_ns).tolist(),
        histories.oldest_ns(frames).tolist(),
        histories.newest_ns(frames).tolist(),
    )
    return [_Told(*row) for row in zip(*columns, strict=True)]


def _stale(shape: ForestShape, histories: Histories, arrivals: Arrivals, now_ns: int) -> Flags:
    """Which rows have been silent for long."""
    stale, frames = np.zeros(len(shape.names), np.bool_), shape.numbers[shape.hung]
    stale[shape.hung] = arrivals.are_stale(frames, now_ns) & ~histories.is_static(frames)
    return stale


def _state(*, is_broken: bool, is_stale: bool) -> Literal["fresh", "stale", "broken"]:
    if is_broken:
        return "broken"
    return "stale" if is_stale else "fresh"


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
