"""sequence: what the actions of one message come to, taken one after another.

An add or delete of a marker undoes what the same message asked for it before, and nothing that is
added before all are deleted is ever seen: only the last word on each marker counts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from studio.displays.markers.kinds import Action

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Flags, Whole

Key: TypeAlias = tuple[str, int]
"""Namespace and id of a marker."""


class Outcome(NamedTuple):
    """What is to be done, in this order."""

    clears_all: bool
    """Whether all that was there goes."""
    cleared: list[str]
    """Namespaces of which all goes."""
    deleted: list[Key]
    added: Whole
    """Shape (A,): which markers of the message are there afterwards; each has a key of its own."""
    twice: Key | None
    """One that the message holds more than once."""


def outcome_of(
    namespaces: Sequence[str], ids: NDArray[np.int32], actions: NDArray[np.int32], taken: Flags
) -> Outcome:
    """Find the last word on each marker.

    Args:
        namespaces: Of the M markers.
        ids: Shape (M,).
        actions: Shape (M,).
        taken: Shape (M,): those that are to be looked at.
    """
    clears_all, cleared, begin = _clears(namespaces, actions, taken)
    spoken = np.flatnonzero(taken & ((actions == Action.ADD) | (actions == Action.DELETE)))
    spoken = spoken[spoken > begin]
    last: dict[Key, int] = {}
    places: list[int] = spoken.tolist()
    for at, marker_id in zip(places, ids[spoken].tolist(), strict=True):
        last[(namespaces[at], marker_id)] = at
    twice = _twice(namespaces, ids, spoken) if len(last) < len(spoken) else None
    adds = actions == Action.ADD
    if cleared or not adds[spoken].all():
        kept = [at for key, at in last.items() if adds[at] and at > cleared.get(key[0], -1)]
        deleted = [key for key, at in last.items() if not adds[at]]
    else:
        kept, deleted = list(last.values()), []
    return Outcome(clears_all, list(cleared), deleted, np.array(sorted(kept), np.intp), twice)


def _clears(
    namespaces: Sequence[str], actions: NDArray[np.int32], taken: Flags
) -> tuple[bool, dict[str, int], int]:
    """Whether all goes, where each namespace is cleared last, and what was added in vain."""
    clears_all, cleared, begin = False, dict[str, int](), -1
    for at in np.flatnonzero(taken & (actions == Action.DELETE_ALL)).tolist():
        if namespaces[at]:
            cleared[namespaces[at]] = at
        else:
            clears_all, begin = True, at
            cleared.clear()
    return clears_all, cleared, begin


def _twice(namespaces: Sequence[str], ids: NDArray[np.int32], spoken: Whole) -> Key | None:
    seen: set[Key] = set()
    places: list[int] = spoken.tolist()
    for at in places:
        key = (namespaces[at], int(ids[at]))
        if key in seen:
            return key
        seen.add(key)
    return None
