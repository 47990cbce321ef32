"""What is to be said of the markers of a display: one sentence for each kind of trouble."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studio.displays.display import Status
from studio.displays.markers.problems import SAID, Problem
from studio.displays.markers.store import REFUSED_MAX

if TYPE_CHECKING:
    from collections.abc import Collection

    from studio.displays.markers.sequence import Key
    from studio.displays.markers.store import MarkerStore

_NAME_MAX = 60


def statuses_of(store: MarkerStore, hidden: Collection[str]) -> list[Status]:
    """The troubles of markers, the worst first; of namespaces that are hidden none."""
    told: dict[Problem, tuple[Key, int]] = {}
    for key, problem in store.refused.items():
        if key[0] not in hidden:
            first, count = told.get(problem, (key, 0))
            told[problem] = first, count + 1
    problems = store.table.problems[: store.table.size]
    rows = np.flatnonzero(problems)
    if hidden:
        shown = [store.table.keys[row][0] not in hidden for row in rows.tolist()]
        rows = rows[np.array(shown, dtype=np.bool_)]
    kinds, firsts, counts = np.unique(problems[rows], return_index=True, return_counts=True)
    for kind, first, count in zip(kinds.tolist(), firsts.tolist(), counts.tolist(), strict=True):
        told[Problem(kind)] = store.table.keys[int(rows[first])], count
    found = [_status(problem, *told[problem]) for problem in sorted(told, reverse=True)]
    return [_twice(store.twice), *found] if store.twice is not None else found


def name_of(key: Key) -> str:
    """A marker as RViz writes it: namespace, slash, id."""
    namespace, marker_id = key
    return f"{namespace[:_NAME_MAX]}/{marker_id}"


def _status(problem: Problem, first: Key, count: int) -> Status:
    said = SAID[problem]
    more = f" (and {count - 1} more, at least)" if count >= REFUSED_MAX else ""
    if 1 < count < REFUSED_MAX:
        more = f" (and {count - 1} more)"
    return Status(said.level, said.reason, f"Marker {name_of(first)}{more} {said.words}.")


def _twice(key: Key) -> Status:
    sentence = f"One message holds marker {name_of(key)} more than once: the last one is shown."
    return Status("error", "bad_message", sentence)
