"""FrameReport: the parent of a frame, its publishers, its rate, age and state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from studio.tf.forest import NONE

if TYPE_CHECKING:
    from studio.tf.arrivals import Arrivals
    from studio.tf.forest import ForestShape
    from studio.tf.histories import Histories
    from studio.tf.transforms import Flags, Numbers


@dataclass(frozen=True, slots=True)
class FrameReport:
    """One frame.

    Attributes:
        frame: Its name.
        parent: None for a root.
        root: The root of its tree.
        publishers: Its publishers; that of the newest transform first.
        static: Whether its transform holds at all times.
        rate_hz: How often transforms come; 0 when that is not known yet.
        age_s: Time since its last transform; None for a root.
        oldest_ns: The first stamp from which it is known.
        newest_ns: The stamp of the newest.
        state: "broken" if nothing connects it with the fixed frame, "stale" if it has been silent
            for long, else "fresh".
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
    """Facts about frames at one time: gathered at once, made into reports later.

    The constructor needs the buffer's lock; `reports` needs none.

    Args:
        shape: Of the forest.
        histories: Of its frames.
        arrivals: Of its frames.
        fixed: What is not connected with it is broken.
        now_ns: By the clock of the arrivals.
        most: Report at most so many, the first by name; None: all.
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
        facts = _facts_of(shape.numbers[hung], histories, arrivals, now_ns)
        self._facts = dict(zip(hung.tolist(), facts, strict=True))
        self._stale = _stale(shape, histories, arrivals, now_ns)

    def reports(self) -> list[FrameReport]:
        """Return a report of each frame, in the order of the alphabet."""
        structure = self._shape.structure
        columns = _Columns(
            structure.parents.tolist(),
            structure.roots.tolist(),
            self._stale.tolist(),
            structure.first_above(self._stale).tolist(),
        )
        return [self._report(row, columns) for row in self._chosen]

    def _report(self, row: int, columns: _Columns) -> FrameReport:
        names, facts = self._shape.names, self._facts.get(row)
        if facts is None:
            return _root(names[row], is_broken=self._broken[row])
        parent = columns.parents[row]
        behind = columns.first_stale[parent]
        return FrameReport(
            names[row],
            names[parent],
            names[columns.roots[row]],
            *facts,
            _state(is_broken=self._broken[row], is_stale=columns.stale[row]),
            None if behind == NONE else names[behind],
        )


class _Facts(NamedTuple):
    """Facts about a frame with a parent, as in a FrameReport."""

    publishers: tuple[str, ...]
    static: bool
    rate_hz: float
    age_s: float
    oldest_ns: int
    newest_ns: int


class _Columns(NamedTuple):
    """Of all rows; `first_stale` is the nearest stale frame from each upwards, or NONE."""

    parents: list[int]
    roots: list[int]
    stale: list[bool]
    first_stale: list[int]


def _facts_of(
    frames: Numbers, histories: Histories, arrivals: Arrivals, now_ns: int
) -> list[_Facts]:
    publishers = [arrivals.publishers_of(frame, now_ns) for frame in frames.tolist()]
    columns = (
        publishers,
        histories.is_static(frames).tolist(),
        arrivals.rates_hz(frames, now_ns).tolist(),
        arrivals.ages_s(frames, now_ns).tolist(),
        histories.oldest_ns(frames).tolist(),
        histories.newest_ns(frames).tolist(),
    )
    return [_Facts(*row) for row in zip(*columns, strict=True)]


def _stale(shape: ForestShape, histories: Histories, arrivals: Arrivals, now_ns: int) -> Flags:
    """Return which rows have been silent for long."""
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
