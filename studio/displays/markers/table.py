"""MarkerTable: every marker that is there, one row for each, as columns that grow."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple, TypeVar

import numpy as np

from studio.displays.markers.problems import NOT_DRAWN, Problem

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Floats, Whole
    from studio.displays.markers.sequence import Key

FOR_EVER: Final = np.iinfo(np.int64).max
NO_BATCH: Final = -1
_ROWS_AT_FIRST: Final = 64
_NOBODY: Final = ("", 0)
N = TypeVar("N", bound=np.generic)


class Items(NamedTuple):
    """The points of one marker, and their colours if it gave each of them one."""

    points: Floats
    """Shape (P, 3), m in the marker."""
    rgba: NDArray[np.float32]
    """Shape (P, 4), or (P/3, 4) of triangles; empty when all have the marker's colour."""


NO_ITEMS: Final = Items(np.empty((0, 3)), np.empty((0, 4), dtype=np.float32))


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Some markers, column by column.

    Attributes:
        rows: Shape (M,): which of the table they are.
        types: Shape (M,), int32.
        positions: Shape (M, 3), m in the frame.
        rotations_wxyz: Shape (M, 4), of length 1.
        scales: Shape (M, 3), as they were sent.
        rgba: Shape (M, 4), 0 to 1 or beyond.
        items: Of each.
        words: Of each: its text, or the address of its mesh.
        embedded: Shape (M,): whether a mesh brings its own colours.
    """

    rows: Whole
    types: NDArray[np.int32]
    positions: Floats
    rotations_wxyz: Floats
    scales: Floats
    rgba: NDArray[np.float32]
    items: tuple[Items, ...]
    words: tuple[str, ...]
    embedded: NDArray[np.bool_]

    def only(self, chosen: NDArray[np.bool_]) -> Rows:
        """Those for which `chosen` (M,) holds."""
        if chosen.all():
            return self
        places = np.flatnonzero(chosen)
        kept: list[int] = places.tolist()
        return Rows(
            self.rows[places], self.types[places], self.positions[places],
            self.rotations_wxyz[places], self.scales[places], self.rgba[places],
            tuple([self.items[place] for place in kept]),
            tuple([self.words[place] for place in kept]),
            self.embedded[places],
        )  # fmt: skip

    def part(self, begin: int, end: int) -> Rows:
        """Those from one place to before another, as views."""
        run = slice(begin, end)
        return Rows(
            self.rows[run], self.types[run], self.positions[run], self.rotations_wxyz[run],
            self.scales[run], self.rgba[run], self.items[run], self.words[run],
            self.embedded[run],
        )  # fmt: skip

    def of_types(self, *types: int) -> Rows:
        """Those of some types."""
        chosen = self.types == types[0]
        for other in types[1:]:
            chosen |= self.types == other
        return self.only(chosen)


class MarkerTable:
    """Rows are given out and taken back; columns of rows that are free hold what was there.

    Attributes:
        batch: To which batch each belongs; NO_BATCH for a free row.
        keys: Namespace and id of each.
        expires_ns: Since the epoch, by the clock of this machine.
        problems: As `Problem`.
        points: How many points each holds.
        size: How many rows were ever given out: all others are free.
    """

    def __init__(self) -> None:
        self.size = 0
        self.batch = np.full(_ROWS_AT_FIRST, NO_BATCH, dtype=np.int64)
        self.types = np.zeros(_ROWS_AT_FIRST, dtype=np.int32)
        self.expires_ns = np.full(_ROWS_AT_FIRST, FOR_EVER, dtype=np.int64)
        self.problems = np.zeros(_ROWS_AT_FIRST, dtype=np.uint8)
        self.points = np.zeros(_ROWS_AT_FIRST, dtype=np.int64)
        self.positions = np.zeros((_ROWS_AT_FIRST, 3))
        self.rotations_wxyz = np.zeros((_ROWS_AT_FIRST, 4))
        self.scales = np.zeros((_ROWS_AT_FIRST, 3))
        self.rgba = np.zeros((_ROWS_AT_FIRST, 4), dtype=np.float32)
        self.embedded = np.zeros(_ROWS_AT_FIRST, dtype=np.bool_)
        self.items: list[Items] = [NO_ITEMS] * _ROWS_AT_FIRST
        self.words: list[str] = [""] * _ROWS_AT_FIRST
        self.keys: list[Key] = [_NOBODY] * _ROWS_AT_FIRST
        self._free: list[int] = []

    def take_row(self, key: Key) -> int:
        """Give out the first free row: who comes again in the same order gets the same rows."""
        if self._free:
            row = heapq.heappop(self._free)
        else:
            if self.size == len(self.batch):
                self._grow()
            row, self.size = self.size, self.size + 1
        self.keys[row] = key
        return row

    def free(self, rows: Iterable[int]) -> None:
        """Take rows back."""
        for row in rows:
            self.batch[row] = NO_BATCH
            self.expires_ns[row] = FOR_EVER
            self.problems[row], self.points[row] = Problem.NONE, 0
            self.items[row], self.words[row], self.keys[row] = NO_ITEMS, "", _NOBODY
            heapq.heappush(self._free, row)

    def drawn_rows(self, batches: Iterable[int]) -> tuple[Whole, NDArray[np.int64]]:
        """Rows of some batches that can be drawn, batch by batch, and the batch of each."""
        wanted = np.isin(self.batch[: self.size], list(batches))
        rows = np.flatnonzero(wanted & (self.problems[: self.size] < NOT_DRAWN))
        rows = rows[np.argsort(self.batch[rows], kind="stable")]
        return rows, self.batch[rows]

    def rows(self, rows: Whole) -> Rows:
        """Copy rows out."""
        chosen: list[int] = rows.tolist()
        return Rows(
            rows, self.types[rows], self.positions[rows], self.rotations_wxyz[rows],
            self.scales[rows], self.rgba[rows],
            tuple([self.items[row] for row in chosen]),
            tuple([self.words[row] for row in chosen]),
            self.embedded[rows],
        )  # fmt: skip

    def _grow(self) -> None:
        more = len(self.batch)
        self.batch = np.concatenate((self.batch, np.full(more, NO_BATCH, dtype=np.int64)))
        self.expires_ns = np.concatenate((self.expires_ns, np.full(more, FOR_EVER)))
        self.types = _doubled(self.types)
        self.problems = _doubled(self.problems)
        self.points = _doubled(self.points)
        self.positions = _doubled(self.positions)
        self.rotations_wxyz = _doubled(self.rotations_wxyz)
        self.scales = _doubled(self.scales)
        self.rgba = _doubled(self.rgba)
        self.embedded = _doubled(self.embedded)
        self.items += [NO_ITEMS] * more
        self.words += [""] * more
        self.keys += [_NOBODY] * more


def _doubled(column: NDArray[N]) -> NDArray[N]:
    return np.concatenate((column, np.zeros_like(column)))
