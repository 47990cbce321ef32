"""Marker and MarkerArray: the markers of their topics, with a switch for each namespace."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from studio.displays.display import Display, Received, Status, TopicRole
from studio.displays.drawing import NOTHING
from studio.displays.markers.batches import MarkerBatches, named_mesh
from studio.displays.markers.kinds import SENTENCES, Problem
from studio.displays.markers.selection import box_of_marker, key_of, key_text, marker_facts
from studio.displays.markers.store import REFUSED_MAX, MarkerStore
from studio.displays.markers.table import NO_BATCH
from studio.displays.properties import Property
from studio.displays.selection import Item, index_of, wxyz_of, xyz_of
from studio.ros.columns.markers import MarkerCodec

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from studio.displays.drawing import Drawing
    from studio.displays.markers.kinds import Key
    from studio.displays.markers.store import BatchKey
    from studio.displays.markers.table import Rows
    from studio.displays.properties import Value
    from studio.displays.selection import Fact, Picked
    from studio.ros.types.library import TypeLibrary

_NAME_MAX = 60
_SINGLE: Final = re.compile(r"-(text|mesh)-\d+$")
"""Names of shapes of one marker each; they end in the row of it."""
MARKER: Final = "visualization_msgs/msg/Marker"
MARKER_ARRAY: Final = "visualization_msgs/msg/MarkerArray"
NAMESPACES: Final = "Namespaces"


def statuses_of(store: MarkerStore, hidden: Collection[str]) -> list[Status]:
    """Return the problems of markers that are not hidden, the worst first."""
    found: dict[Problem, tuple[Key, int]] = {}
    for key, problem in store.refused.items():
        if key[0] not in hidden:
            first, count = found.get(problem, (key, 0))
            found[problem] = first, count + 1
    problems = store.table.problems[: store.table.size]
    rows = np.flatnonzero(problems)
    if hidden:
        shown = [store.table.keys[row][0] not in hidden for row in rows.tolist()]
        rows = rows[np.array(shown, dtype=np.bool_)]
    kinds, firsts, counts = np.unique(problems[rows], return_index=True, return_counts=True)
    for kind, first, count in zip(kinds.tolist(), firsts.tolist(), counts.tolist(), strict=True):
        found[Problem(kind)] = store.table.keys[int(rows[first])], count
    statuses = [_status(problem, *found[problem]) for problem in sorted(found, reverse=True)]
    return [_duplicate(store.twice), *statuses] if store.twice is not None else statuses


def marker_name(key: Key) -> str:
    """Return a marker as RViz writes it: namespace, slash, id."""
    namespace, marker_id = key
    return f"{namespace[:_NAME_MAX]}/{marker_id}"


def _status(problem: Problem, first: Key, count: int) -> Status:
    sentence = SENTENCES[problem]
    more = f" (and {count - 1} more, at least)" if count >= REFUSED_MAX else ""
    if 1 < count < REFUSED_MAX:
        more = f" (and {count - 1} more)"
    return Status(
        sentence.level, sentence.reason, f"Marker {marker_name(first)}{more} {sentence.text}."
    )


def _duplicate(key: Key) -> Status:
    sentence = f"One message holds marker {marker_name(key)} more than once: the last one is shown."
    return Status("error", "bad_message", sentence)


class MarkersDisplay(Display):
    """Markers of all topics of the display in one store, with a check for each namespace.

    A namespace has a property from its first marker on. One that was switched off before, as in a
    saved display, is off when its first marker comes. Switching all off and on again leaves each
    as it was, so that saved settings mean the same in any order.
    """

    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property(
            NAMESPACES, "switch", default=True, doc="Shows the namespaces that are on, or none."
        ),
    )
    SETTINGS_MAX = 2000

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._store = MarkerStore()
        self._batches = MarkerBatches()
        self._codec = MarkerCodec()
        self._has_messages = False

    def properties(self) -> tuple[Property, ...]:
        """Return the switch for all, and one for each namespace so far."""
        return (
            *self.PROPERTIES,
            *(_switch(_name_of(one)) for one in self._store.namespaces_so_far),
        )

    def take(self, received: Received, role: str = "") -> None:
        """Take in a message.

        Raises:
            CdrError: The bytes are no such message.
        """
        del role
        if received.type_name == MARKER:
            columns = self._codec.decode_single(received.cdr)
        else:
            columns = self._codec.decode(received.cdr)
        self._has_messages = True
        self._store.take(columns, received.received_ns)

    def reset(self) -> None:
        """Forget all markers and namespaces; what was set of them stays."""
        self._store = MarkerStore()
        self._has_messages = False

    def draw(self, now_ns: int) -> Drawing:
        """Draw the markers that exist now, ns since the epoch."""
        self._store.expire(now_ns)
        if not self.values[NAMESPACES]:
            return NOTHING
        return self._batches.draw(self._store, self._hidden())

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the keys of markers."""
        table = self._store.table
        rows = np.array([index_of(picked.shape.rpartition("-")[2])])
        if not _SINGLE.search(picked.shape):
            rows = np.unique(picked.rows)
        inside = rows[(rows >= 0) & (rows < table.size)]
        there: list[int] = inside[table.batch[inside] != NO_BATCH].tolist()
        return [key_text(table.keys[row]) for row in there]

    def item(self, key: str) -> Item | None:
        """Return a marker that is drawn."""
        found = self._found(key)
        if found is None:
            return None
        marker, batch, path = found
        stamp_ns, named = batch.stamp_ns, key_of(key)
        name = marker_name(named) if named else key
        pose = xyz_of(marker.positions[0]), wxyz_of(marker.rotations_wxyz[0])
        box = box_of_marker(marker)
        shape = "" if box is not None else named_mesh(int(marker.rows[0]), batch.namespace)
        return Item("marker", name, path, batch.frame, stamp_ns, box, *pose, shape)

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return what is known of a marker."""
        found, named = self._found(key), key_of(key)
        return () if found is None or named is None else marker_facts(named, found[0])

    def _found(self, key: str) -> tuple[Rows, BatchKey, str] | None:
        named = key_of(key)
        row = self._store.row_of(named) if named is not None else None
        if row is None or (named is not None and named[0] in self._hidden()):
            return None
        batch = self._store.batches.get(int(self._store.table.batch[row]))
        path = self._batches.path_of(batch) if batch is not None else None
        if batch is None or path is None:
            return None
        return self._store.table.rows(np.array([row])), batch, path

    def statuses(self) -> tuple[Status, ...]:
        """Return the problems of markers, and why nothing is seen of those that exist."""
        hidden = self._hidden()
        found = statuses_of(self._store, hidden)
        if self._has_messages and not len(self._store) and not self._store.refused:
            sentence = "There are no markers: all were deleted, or their lifetime is over."
            found.append(Status("warn", "empty", sentence))
        elif len(self._store) and self._store.namespaces() <= hidden:
            sentence = "Markers are there, and all of their namespaces are switched off."
            found.append(Status("warn", "empty", sentence, (self._first_off(), True)))
        if self._batches.left_out:
            left_out = self._batches.left_out
            sentence = f"{left_out} texts, meshes or batches are too many to be shown."
            found.append(Status("warn", "unsupported", sentence))
        return tuple(found)

    def _hidden(self) -> frozenset[str]:
        if not self.values[NAMESPACES]:
            return frozenset(self._store.namespaces())
        if all(self.values.values()):
            return frozenset()
        begin = len(_name_of(""))
        return frozenset(name[begin:] for name, shown in self.values.items() if not shown)

    def _first_off(self) -> str:
        if not self.values[NAMESPACES]:
            return NAMESPACES
        return _name_of(min(self._store.namespaces()))

    def _property(self, name: str) -> Property:
        if name.startswith(_name_of("")):
            return _switch(name)
        return super()._property(name)


def _name_of(namespace: str) -> str:
    return f"{NAMESPACES}/{namespace}"


def _switch(name: str) -> Property:
    return Property(name, "switch", default=True, doc="Shows the markers of this namespace.")


class MarkerDisplay(MarkersDisplay):
    """Single markers, and arrays of them on the topic that ends in `_array`, as in RViz."""

    KIND = "Marker"
    DOC = "Shows single markers: arrows, solids, lines, points, surfaces, texts and meshes."
    ICON = "shapes"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", (MARKER,), newest_only=False, latched=True, depth=1000),
        TopicRole("array", (MARKER_ARRAY,), "_array", newest_only=False, latched=True, depth=10),
    )


class MarkerArrayDisplay(MarkersDisplay):
    """Arrays of markers; each changes, adds or deletes those that it names, and no others."""

    KIND = "MarkerArray"
    DOC = "Shows many markers at once: arrows, solids, lines, points, surfaces, texts and meshes."
    ICON = "shapes"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", (MARKER_ARRAY,), newest_only=False, latched=True, depth=10),
    )
