"""MarkerBatches: a store batch by batch, with every shape kept that did not change."""

from __future__ import annotations

import hashlib
import heapq
from dataclasses import fields, replace
from itertools import islice
from typing import TYPE_CHECKING, Final, TypeAlias, cast

import numpy as np

from studio.displays.drawing import NOTHING, MeshFile, Placed, Points, Text
from studio.displays.markers.kinds import Kind
from studio.displays.markers.lists import lines_of, points_of, singles_of, triangles_of
from studio.displays.markers.solids import arrows_of, solids_of

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Drawing, Shape
    from studio.displays.markers.kinds import Flags
    from studio.displays.markers.store import BatchKey, MarkerStore
    from studio.displays.markers.table import Rows

Array: TypeAlias = "NDArray[np.float32] | NDArray[np.uint8]"

SHAPES_MAX: Final = 8192
BATCHES_MAX: Final = 2048
_Place = tuple[str, int, bool]
"""Frame, stamp and whether it is followed: what a group of shapes has in common."""


class MarkerBatches:
    """Keeps what was drawn.

    Attributes:
        left_out: How many shapes were too many in the last drawing.
    """

    def __init__(self) -> None:
        self.left_out = 0
        self._drawing: Drawing = NOTHING
        self._shapes: dict[int, tuple[BatchKey, dict[str, Shape]]] = {}
        self._hidden: frozenset[str] = frozenset()
        self._paths = _Paths()

    def draw(self, store: MarkerStore, hidden: frozenset[str]) -> Drawing:
        """Draw what is new.

        Args:
            store: Of the markers.
            hidden: Namespaces that are not to be seen.
        """
        dirty = store.take_dirty()
        gone = self._shapes.keys() - store.batches.keys()
        if not dirty and not gone and hidden == self._hidden:
            return self._drawing
        for number in gone:
            del self._shapes[number]
        if hidden != self._hidden:
            dirty.update(number for number, key in store.batches.items() if key.namespace is None)
        self._hidden = hidden
        self._build(store, dirty)
        self._drawing = self._assembled(max(0, len(store.batches) - BATCHES_MAX))
        return self._drawing

    def path_of(self, key: BatchKey) -> str | None:
        """Return the path of the group that a batch is drawn in; None if it is not drawn."""
        if key.namespace in self._hidden:
            return None
        return self._paths.known((key.frame, key.stamp_ns, key.follows))

    def _build(self, store: MarkerStore, dirty: set[int]) -> None:
        first = islice(store.batches, BATCHES_MAX)
        wanted = [number for number in first if number in dirty or number not in self._shapes]
        rows, numbers = store.table.drawn_rows(wanted)
        markers = store.table.rows(rows)
        for number in wanted:
            begin, end = np.searchsorted(numbers, (number, number + 1)).tolist()
            part, key = markers.part(begin, end), store.batches[number]
            if key.namespace is None and self._hidden:
                part = part.only(self._seen(store, part))
            self._shapes[number] = key, _named(shapes_of(part), key.namespace)

    def _seen(self, store: MarkerStore, part: Rows) -> Flags:
        rows: list[int] = part.rows.tolist()
        shown = [store.table.keys[row][0] not in self._hidden for row in rows]
        return np.array(shown, dtype=np.bool_)

    def _assembled(self, left_out: int) -> Drawing:
        groups: dict[_Place, list[dict[str, Shape]]] = {}
        count, self.left_out = 0, left_out
        for key, shapes in self._shapes.values():
            if key.namespace in self._hidden or not shapes:
                continue
            if count + len(shapes) > SHAPES_MAX:
                self.left_out += len(shapes)
                continue
            count += len(shapes)
            groups.setdefault((key.frame, key.stamp_ns, key.follows), []).append(shapes)
        self._paths.keep_only(groups)
        drawn: dict[str, Placed] = {}
        for place, parts in groups.items():
            path = self._paths.of(place)
            drawn[path] = _placed(place, parts, self._drawing.get(path))
        if drawn.keys() == self._drawing.keys() and all(
            placed is self._drawing[path] for path, placed in drawn.items()
        ):
            return self._drawing
        return drawn


class _Paths:
    """Short paths that are used again, so that what is drawn again takes the place of the old."""

    def __init__(self) -> None:
        self._of: dict[_Place, str] = {}
        self._free: list[int] = []
        self._next = 0

    def keep_only(self, places: Collection[_Place]) -> None:
        """Let the paths of others be used again."""
        for place in [one for one in self._of if one not in places]:
            heapq.heappush(self._free, int(self._of.pop(place)[1:]))

    def known(self, place: _Place) -> str | None:
        """Return the path of a group that was drawn; None if it was not."""
        return self._of.get(place)

    def of(self, place: _Place) -> str:
        """Return the path of a group; the lowest that is free for a new one."""
        path = self._of.get(place)
        if path is None:
            if not self._free:
                heapq.heappush(self._free, self._next)
                self._next += 1
            path = self._of[place] = f"g{heapq.heappop(self._free)}"
        return path


def shapes_of(markers: Rows) -> dict[str, Shape]:
    """Everything that some markers of one frame show, by name."""
    kinds = set(markers.types.tolist())
    shapes: dict[str, Shape] = {}
    if kinds & {Kind.CUBE, Kind.SPHERE, Kind.CYLINDER, Kind.CUBE_LIST, Kind.SPHERE_LIST}:
        shapes.update(solids_of(markers))
    if kinds & {Kind.ARROW, Kind.ARROW_STRIP}:
        shapes.update(arrows_of(markers))
    if kinds & {Kind.LINE_STRIP, Kind.LINE_LIST}:
        shapes.update(lines_of(markers))
    if Kind.POINTS in kinds:
        shapes.update(points_of(markers))
    if Kind.TRIANGLES in kinds:
        shapes.update(triangles_of(markers))
    if kinds & {Kind.TEXT, Kind.MESH}:
        shapes.update(singles_of(markers))
    return shapes


def _named(shapes: Mapping[str, Shape], namespace: str | None) -> dict[str, Shape]:
    """Return names that no other namespace has, without slashes whatever its own is."""
    mark = _mark(namespace)
    return {f"{mark}-{name}": shape for name, shape in shapes.items()}


def named_mesh(row: int, namespace: str | None) -> str:
    """Return the name of the shape of one marker's mesh by its row in the table."""
    return f"{_mark(namespace)}-mesh-{row}"


def _mark(namespace: str | None) -> str:
    if namespace is None:
        return "rest"
    return hashlib.blake2b(namespace.encode(), digest_size=6).hexdigest()


def _placed(place: _Place, parts: list[dict[str, Shape]], before: Placed | None) -> Placed:
    """Return a group with the earlier shapes that look the same; the earlier group if all do."""
    frame, stamp_ns, follows = place
    old: Mapping[str, Shape] = before.shapes if before is not None else {}
    shapes: dict[str, Shape] = {}
    for part in parts:
        part.update({name: _kept(shape, old.get(name)) for name, shape in part.items()})
        shapes.update(part)
    is_same = (
        before is not None
        and (before.frame, before.stamp_ns, before.follows) == place
        and shapes.keys() == old.keys()
        and all(shape is old[name] for name, shape in shapes.items())
    )
    return before if before is not None and is_same else Placed(frame, stamp_ns, shapes, follows)


def _kept(shape: Shape, before: Shape | None) -> Shape:
    """Return the earlier shape if it looks the same, else a new one with the arrays that do."""
    if before is None or shape is before or type(shape) is not type(before):
        return shape
    if isinstance(shape, Text | MeshFile):
        return before if shape == before else shape
    if isinstance(shape, Points) and isinstance(before, Points) and before.precise:
        # Once needed it stays: points near the limit would otherwise be sent again and again.
        shape = replace(shape, precise=True)
    names = [one.name for one in fields(shape)]
    same = {name: getattr(before, name) for name in names if _same(shape, before, name)}
    return before if len(same) == len(names) else replace(shape, **same)


def _same(one: Shape, other: Shape, name: str) -> bool:
    mine: object = getattr(one, name)
    theirs: object = getattr(other, name)
    if type(mine) is not type(theirs):
        return False
    if isinstance(mine, np.ndarray):
        return bool(np.array_equal(cast("Array", mine), cast("Array", theirs)))
    return mine == theirs
