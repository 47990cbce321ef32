"""MarkerStore: which markers exist, by namespace and id, and until when."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.markers.kinds import Action, Key, Problem
from studio.displays.markers.table import FOR_EVER, NO_BATCH, MarkerTable
from studio.displays.turning import drawable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Flags, Whole
    from studio.displays.markers.store import Key, Named
    from studio.ros.columns.markers import MarkerColumns, MarkerTexts

_KEPT: Final = 4
_BYTES_KEPT_MAX: Final = 1 << 20
STAMPS_MAX: Final = 256
"""Limit for one message: of more, those close to each other are taken as one."""
_CLOSE_NS: Final = 10_000_000
MARKERS_MAX: Final = 50_000
NAMESPACES_MAX: Final = 1000
APART_MAX: Final = 32
"""Namespaces that are drawn each by itself; all others are drawn as one."""
REFUSED_MAX: Final = 1000
# RViz takes what lasts no longer than this for a marker that stays.
_LIFETIME_LEAST_NS: Final = 100_000
_ACTIONS: Final = np.array(list(Action), dtype=np.int32)
_ADD: Final = int(Action.ADD)


class BatchKey(NamedTuple):
    """The properties shared by markers that are drawn together."""

    frame: str
    """Without a leading slash, as RViz looks it up."""
    stamp_ns: int
    """0 for those that follow their frame: the newest transform counts."""
    follows: bool
    namespace: str | None
    """None: any of those that are not drawn apart."""


class Named(NamedTuple):
    """The names of M markers, made once for texts that come again."""

    texts: tuple[MarkerTexts, ...]
    namespaces: list[str]
    """Namespace of each."""
    pairs: NDArray[np.int64]
    """Shape (M,): the same number where frame and namespace are the same."""
    nameless: Flags
    """Shape (M,): which name no frame."""


class Naming:
    """Remembers the last messages: a publisher sends the same names over and over."""

    def __init__(self) -> None:
        self._known: list[Named] = []

    def named(self, texts: tuple[MarkerTexts, ...]) -> Named:
        """Number the frames and namespaces of a message."""
        for known in self._known:
            if known.texts is texts:
                return known
        made = _named(texts)
        if sum(len(one.mesh_file_data) for one in texts) < _BYTES_KEPT_MAX:
            self._known = [made, *self._known[: _KEPT - 1]]
        return made


def _named(texts: tuple[MarkerTexts, ...]) -> Named:
    numbers: dict[tuple[str, str], int] = {}
    pairs = [numbers.setdefault((one.frame, one.namespace), len(numbers)) for one in texts]
    return Named(
        texts,
        [one.namespace for one in texts],
        np.array(pairs, dtype=np.int64),
        np.array([one.frame in ("", "/") for one in texts], dtype=np.bool_),
    )


def batch_keys(
    columns: MarkerColumns, named: Named, chosen: Whole, is_apart: Callable[[str], bool]
) -> tuple[list[BatchKey], Whole]:
    """Sort markers into batches.

    Args:
        columns: Of a message.
        named: Of the same message.
        chosen: Shape (M,): which of its markers, at least one.
        is_apart: Whether a namespace is drawn apart from others.

    Returns:
        Keys, some of them perhaps the same, and which of them each marker (M,) has.
    """
    locked = columns.frame_locked[chosen]
    stamps_ns = few_stamps(np.where(locked, 0, columns.stamps_ns[chosen]))
    codes = 2 * named.pairs[chosen] + locked
    if stamps_ns.min() != stamps_ns.max():
        distinct, moments = np.unique(stamps_ns, return_inverse=True)
        codes = codes * len(distinct) + moments
    _, first, inverse = np.unique(codes, return_index=True, return_inverse=True)
    keys: list[BatchKey] = []
    for at in first.tolist():
        text = columns.texts[int(chosen[at])]
        frame = text.frame.removeprefix("/")
        namespace = text.namespace if is_apart(text.namespace) else None
        keys.append(BatchKey(frame, int(stamps_ns[at]), bool(locked[at]), namespace))
    return keys, inverse


def few_stamps(stamps_ns: NDArray[np.int64]) -> NDArray[np.int64]:
    """Stamps (N,) of one message; if there are too many, groups of them have that of the first.

    A publisher that stamps each marker as it makes it needs no transform for each: stamps within
    10 ms become one, or within more if they span a longer time.
    """
    distinct = np.unique(stamps_ns)
    if len(distinct) <= STAMPS_MAX:
        return stamps_ns
    least, span_ns = int(distinct[0]), int(distinct[-1]) - int(distinct[0])
    width_ns = max(_CLOSE_NS, span_ns // STAMPS_MAX + 1)
    groups = (distinct - least) // width_ns
    _, first, inverse = np.unique(groups, return_index=True, return_inverse=True)
    return distinct[first][inverse][np.searchsorted(distinct, stamps_ns)]


class Outcome(NamedTuple):
    """What to do, in this order."""

    clears_all: bool
    """Whether all markers are deleted first."""
    cleared: list[str]
    """Namespaces whose markers are all deleted."""
    deleted: list[Key]
    added: Whole
    """Shape (A,): which markers of the message exist afterwards; their keys differ."""
    twice: Key | None
    """A marker that the message has more than once."""


def outcome_of(
    namespaces: Sequence[str], ids: NDArray[np.int32], actions: NDArray[np.int32], taken: Flags
) -> Outcome:
    """Find what the actions of one message come to: the last add or delete of each marker counts.

    Args:
        namespaces: Of the M markers.
        ids: Shape (M,).
        actions: Shape (M,).
        taken: Shape (M,): those that count.
    """
    clears_all, cleared, begin = _clears(namespaces, actions, taken)
    named = np.flatnonzero(taken & ((actions == Action.ADD) | (actions == Action.DELETE)))
    named = named[named > begin]
    last: dict[Key, int] = {}
    places: list[int] = named.tolist()
    for at, marker_id in zip(places, ids[named].tolist(), strict=True):
        last[(namespaces[at], marker_id)] = at
    twice = _duplicate(namespaces, ids, named) if len(last) < len(named) else None
    adds = actions == Action.ADD
    if cleared or not adds[named].all():
        kept = [at for key, at in last.items() if adds[at] and at > cleared.get(key[0], -1)]
        deleted = [key for key, at in last.items() if not adds[at]]
    else:
        kept, deleted = list(last.values()), []
    return Outcome(clears_all, list(cleared), deleted, np.array(sorted(kept), np.intp), twice)


def _clears(
    namespaces: Sequence[str], actions: NDArray[np.int32], taken: Flags
) -> tuple[bool, dict[str, int], int]:
    """Return whether all is deleted, where each namespace is last, and the last such place."""
    clears_all, cleared, begin = False, dict[str, int](), -1
    for at in np.flatnonzero(taken & (actions == Action.DELETE_ALL)).tolist():
        if namespaces[at]:
            cleared[namespaces[at]] = at
        else:
            clears_all, begin = True, at
            cleared.clear()
    return clears_all, cleared, begin


def _duplicate(namespaces: Sequence[str], ids: NDArray[np.int32], named: Whole) -> Key | None:
    seen: set[Key] = set()
    places: list[int] = named.tolist()
    for at in places:
        key = (namespaces[at], int(ids[at]))
        if key in seen:
            return key
        seen.add(key)
    return None


class _LastAdd(NamedTuple):
    """A message that only added markers, all of which were accepted."""

    named: Named
    ids: NDArray[np.int32]
    rows: Whole
    deletions: int
    """Number of deletions before it."""


class MarkerStore:
    """Takes messages, and returns which batches of markers have to be drawn again.

    Attributes:
        table: Of the markers.
        batches: Those that hold a marker, by number; a number is never given out twice.
        namespaces_so_far: In the order of their first markers; a bounded number.
        refused: What is wrong with markers that were not taken in; a bounded number.
        twice: A marker that the last message held more than once.
    """

    def __init__(self) -> None:
        self.table = MarkerTable()
        self.batches: dict[int, BatchKey] = {}
        self.namespaces_so_far: dict[str, None] = {}
        self.refused: dict[Key, Problem] = {}
        self.twice: Key | None = None
        self._rows: dict[Key, int] = {}
        self._numbers: dict[BatchKey, int] = {}
        self._counts: dict[int, int] = {}
        self._dirty: set[int] = set()
        self._next_number = 0
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
        """Delete the markers whose lifetime is over."""
        if now_ns < self._next_end_ns:
            return
        ends_ns = self.table.expires_ns[: self.table.size]
        over = set(np.flatnonzero(ends_ns <= now_ns).tolist())
        self._delete([key for key, row in self._rows.items() if row in over])
        self._next_end_ns = int(self.table.expires_ns.min())

    def take_dirty(self) -> set[int]:
        """Return the batches that changed since the last call; deleted ones are not among them."""
        dirty, self._dirty = self._dirty, set()
        return dirty

    def row_of(self, key: Key) -> int | None:
        """Return the row of a marker in the table; None if there is none."""
        return self._rows.get(key)

    def namespaces(self) -> set[str]:
        """Namespaces with a marker."""
        return {namespace for namespace, _ in self._rows}

    def _taken(self, columns: MarkerColumns, named: Named) -> Flags:
        """Return which markers count; RViz ignores the others, whatever their action."""
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
        """Return the rows of a message that has the very same markers as the last one."""
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
        changed = self.table.fill(columns, named.nameless, rows, added)
        self._put_ends(columns.lifetimes_ns[added], rows, received_ns)
        self._put_batches(batch_keys(columns, named, added, self._is_apart), rows, changed)

    def _put_ends(self, lifetimes_ns: NDArray[np.int64], rows: Whole, received_ns: int) -> None:
        ends = lifetimes_ns > _LIFETIME_LEAST_NS
        self.table.expires_ns[rows] = np.where(ends, received_ns + lifetimes_ns, FOR_EVER)
        if ends.any():
            soonest_ns = received_ns + int(lifetimes_ns[ends].min())
            self._next_end_ns = min(self._next_end_ns, soonest_ns)

    def _rows_for(self, keys: list[Key], added: Whole) -> tuple[Whole, Whole]:
        """Return the rows of markers, new ones where needed, and which markers got one."""
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
        """Put markers into their batches; those that hold what changed are to be drawn again."""
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
        """Whether a namespace is drawn by itself, as the first ones are."""
        if len(self.namespaces_so_far) < NAMESPACES_MAX:
            self.namespaces_so_far.setdefault(namespace)
        if len(self._apart) < APART_MAX:
            self._apart.add(namespace)
        return namespace in self._apart
