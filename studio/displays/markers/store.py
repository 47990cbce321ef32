"""MarkerStore: who is there, by namespace and id, and until when."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.markers.filling import Filling
from studio.displays.markers.kinds import Action
from studio.displays.markers.naming import BatchKey, Naming, batch_keys
from studio.displays.markers.problems import Problem
from studio.displays.markers.sequence import outcome_of
from studio.displays.markers.table import FOR_EVER, NO_BATCH, MarkerTable
from studio.displays.turning import drawable

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Flags, Whole
    from studio.displays.markers.naming import Named
    from studio.displays.markers.sequence import Key
    from studio.ros.columns.markers import MarkerColumns

MARKERS_MAX: Final = 50_000
NAMESPACES_MAX: Final = 1000
APART_MAX: Final = 32
"""Namespaces that are drawn each by itself; all others are drawn as one."""
REFUSED_MAX: Final = 1000
# RViz takes what lasts no longer than this for a marker that stays.
_LIFETIME_LEAST_NS: Final = 100_000
_ACTIONS: Final = np.array(list(Action), dtype=np.int32)
_ADD: Final = int(Action.ADD)


class _LastAdd(NamedTuple):
    """Of a message that added nothing but markers that were all taken in."""

    named: Named
    ids: NDArray[np.int32]
    rows: Whole
    deletions: int
    """How often markers were deleted before it."""


class MarkerStore:
    """Takes messages in, and tells which batches of markers are to be drawn anew.

    Attributes:
        table: Of the markers.
        batches: Those that hold a marker, by number; a number is never given out twice.
        heard: Namespaces in the order in which they were heard of first; a bounded number.
        refused: What is wrong with markers that were not taken in; a bounded number.
        twice: A marker that the last message held more than once.
    """

    def __init__(self) -> None:
        self.table = MarkerTable()
        self.batches: dict[int, BatchKey] = {}
        self.heard: dict[str, None] = {}
        self.refused: dict[Key, Problem] = {}
        self.twice: Key | None = None
        self._rows: dict[Key, int] = {}
        self._numbers: dict[BatchKey, int] = {}
        self._counts: dict[int, int] = {}
        self._dirty: set[int] = set()
        self._next_number = 0
        self._filling = Filling(self.table)
        self._next_end_ns = FOR_EVER
        self._naming = Naming()
        self._apart: set[str] = set()
        self._deletions = 0
        self._last: _LastAdd | None = None

    def __len__(self) -> int:
        return len(self._rows)

    def take(self, columns: MarkerColumns, received_ns: int) -> None:
        """Take in the markers of a message, in their order.

        Args:
            columns: Of the message.
            received_ns: When it came, since the epoch; lifetimes begin then.
        """
        named = self._naming.named(columns.texts)
        taken = self._taken(columns, named)
        again = self._rows_again(columns, named, taken)
        if again is not None:
            self.twice = None
            self._put_all(columns, named, again, np.arange(len(again)), received_ns)
            return
        outcome = outcome_of(named.namespaces, columns.ids, columns.actions, taken)
        self.twice = outcome.twice
        if outcome.clears_all:
            self._clear()
        elif outcome.cleared:
            gone = set(outcome.cleared)
            self._delete([key for key in self._rows if key[0] in gone])
        self._delete(outcome.deleted)
        if len(outcome.added):
            self._add(columns, named, outcome.added, received_ns)

    def expire(self, now_ns: int) -> None:
        """Let those go whose lifetime is over."""
        if now_ns < self._next_end_ns:
            return
        ends_ns = self.table.expires_ns[: self.table.size]
        over = set(np.flatnonzero(ends_ns <= now_ns).tolist())
        self._delete([key for key, row in self._rows.items() if row in over])
        self._next_end_ns = int(self.table.expires_ns.min())

    def take_dirty(self) -> set[int]:
        """Which batches are to be drawn anew since this was asked; those that are gone are not."""
        dirty, self._dirty = self._dirty, set()
        return dirty

    def namespaces(self) -> set[str]:
        """Those that hold a marker now."""
        return {namespace for namespace, _ in self._rows}

    def _taken(self, columns: MarkerColumns, named: Named) -> Flags:
        """Which markers are looked at: RViz passes over others, whatever they ask for."""
        finite = np.ones(len(columns.texts), dtype=np.bool_)
        rgba = columns.colors_rgba.astype(np.float64)
        for numbers in (columns.positions, columns.rotations_wxyz, columns.scales, rgba):
            finite &= drawable(numbers)
        if len(columns.points):
            bad_points = np.flatnonzero(~drawable(columns.points))
            finite[np.searchsorted(columns.point_starts, bad_points, side="right") - 1] = False
        known = np.isin(columns.actions, _ACTIONS)
        self._refuse(columns, named, np.flatnonzero(~finite), Problem.NOT_FINITE)
        self._refuse(columns, named, np.flatnonzero(finite & ~known), Problem.UNKNOWN_ACTION)
        return finite & known

    def _refuse(self, columns: MarkerColumns, named: Named, which: Whole, problem: Problem) -> None:
        for at in which[:REFUSED_MAX].tolist():
            if len(self.refused) < REFUSED_MAX:
                self.refused[(named.namespaces[at], int(columns.ids[at]))] = problem

    def _clear(self) -> None:
        self.refused.clear()
        self._delete(list(self._rows))

    def _delete(self, keys: Iterable[Key]) -> None:
        rows: list[int] = []
        for key in keys:
            self.refused.pop(key, None)
            row = self._rows.pop(key, None)
            if row is not None:
                rows.append(row)
        if rows:
            self._deletions += 1
            gone = np.array(rows, dtype=np.intp)
            self._filling.forget(gone)
            self._leave(gone)
            self.table.free(rows)

    def _add(self, columns: MarkerColumns, named: Named, added: Whole, received_ns: int) -> None:
        places: list[int] = added.tolist()
        ids: list[int] = columns.ids[added].tolist()
        keys = [(named.namespaces[at], each) for at, each in zip(places, ids, strict=True)]
        if self.refused:
            for key in keys:
                self.refused.pop(key, None)
        rows, added = self._rows_for(keys, added)
        if len(rows) == len(columns.ids):
            self._last = _LastAdd(named, columns.ids, rows, self._deletions)
        self._put_all(columns, named, rows, added, received_ns)

    def _rows_again(self, columns: MarkerColumns, named: Named, taken: Flags) -> Whole | None:
        """The rows of a message that says again of the very same markers what they are now."""
        last = self._last
        if (
            last is None
            or last.named is not named
            or last.deletions != self._deletions
            or self.refused
            or not np.array_equal(last.ids, columns.ids)
            or (columns.actions != _ADD).any()
            or not taken.all()
        ):
            return None
        return last.rows

    def _put_all(
        self, columns: MarkerColumns, named: Named, rows: Whole, added: Whole, received_ns: int
    ) -> None:
        if not len(rows):
            return
        changed = self._filling.fill(columns, named, rows, added)
        self._put_ends(columns.lifetimes_ns[added], rows, received_ns)
        self._put_batches(batch_keys(columns, named, added, self._is_apart), rows, changed)

    def _put_ends(self, lifetimes_ns: NDArray[np.int64], rows: Whole, received_ns: int) -> None:
        ends = lifetimes_ns > _LIFETIME_LEAST_NS
        self.table.expires_ns[rows] = np.where(ends, received_ns + lifetimes_ns, FOR_EVER)
        if ends.any():
            soonest_ns = received_ns + int(lifetimes_ns[ends].min())
            self._next_end_ns = min(self._next_end_ns, soonest_ns)

    def _rows_for(self, keys: list[Key], added: Whole) -> tuple[Whole, Whole]:
        """Rows of the table for markers, new ones where none were, and who has got one."""
        rows = [self._rows.get(key, NO_BATCH) for key in keys]
        for at, row in enumerate(rows):
            if row == NO_BATCH:
                if len(self._rows) < MARKERS_MAX:
                    rows[at] = self._rows[keys[at]] = self.table.take_row(keys[at])
                elif len(self.refused) < REFUSED_MAX:
                    self.refused[keys[at]] = Problem.TOO_MANY
        found = np.array(rows, dtype=np.intp)
        has_one = found != NO_BATCH
        return found[has_one], added[has_one]

    def _put_batches(
        self, sorted_in: tuple[list[BatchKey], Whole], rows: Whole, changed: Flags
    ) -> None:
        """Put markers into their batches; those that hold what changed are to be drawn anew."""
        keys, which = sorted_in
        numbers = np.array([self._number(key) for key in keys], dtype=np.int64)[which]
        moved = self.table.batch[rows] != numbers
        entered, counts = np.unique(numbers[moved], return_counts=True)
        for number, count in zip(entered.tolist(), counts.tolist(), strict=True):
            self._counts[number] = self._counts.get(number, 0) + count
        self._leave(rows[moved])
        self._dirty.update(np.unique(numbers[moved | changed]).tolist())
        self.table.batch[rows] = numbers

    def _leave(self, rows: Whole) -> None:
        """Markers are in their batches no more; a batch that holds none is forgotten."""
        numbers, counts = np.unique(self.table.batch[rows], return_counts=True)
        for number, count in zip(numbers.tolist(), counts.tolist(), strict=True):
            if number == NO_BATCH:
                continue
            self._counts[number] -= count
            if self._counts[number]:
                self._dirty.add(number)
            else:
                del self._counts[number], self._numbers[self.batches.pop(number)]
                self._dirty.discard(number)

    def _number(self, key: BatchKey) -> int:
        number = self._numbers.get(key)
        if number is None:
            number = self._numbers[key] = self._next_number
            self._next_number += 1
            self.batches[number] = key
        return number

    def _is_apart(self, namespace: str) -> bool:
        """Whether a namespace is drawn by itself: those that were heard of first are."""
        if len(self.heard) < NAMESPACES_MAX:
            self.heard.setdefault(namespace)
        if len(self._apart) < APART_MAX:
            self._apart.add(namespace)
        return namespace in self._apart
