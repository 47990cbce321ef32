"""Filling: writes what a message says of markers into their rows of the table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.markers.kinds import COLOURED_POINTS, Kind
from studio.displays.markers.problems import Looked, Problem, problems_of
from studio.displays.markers.table import NO_ITEMS, Items
from studio.displays.turning import unit_quaternions

if TYPE_CHECKING:
    from studio.displays.markers.kinds import Flags, Whole
    from studio.displays.markers.naming import Named
    from studio.displays.markers.table import MarkerTable
    from studio.ros.columns.markers import MarkerColumns, MarkerTexts

POINTS_MAX: Final = 2_000_000
WORDS_MAX: Final = 2000
_MESH_SCHEMES: Final = ("package://", "file://")
_WORDED: Final = np.array([Kind.TEXT, Kind.MESH], dtype=np.int32)
# Members of an IntEnum are slow to come by in a loop.
_CLEAR, _EMPTY_TEXT = int(Problem.CLEAR), int(Problem.EMPTY_TEXT)
_NO_MESH, _FOREIGN_MESH = int(Problem.NO_MESH), int(Problem.FOREIGN_MESH)


class Filling:
    """Fills rows of one table, and counts the points that all of them hold."""

    def __init__(self, table: MarkerTable) -> None:
        self._table = table
        self._points = 0

    def fill(self, columns: MarkerColumns, named: Named, rows: Whole, added: Whole) -> Flags:
        """Write markers into their rows.

        Args:
            columns: Of a message.
            named: Of the same message.
            rows: Shape (A,), each another.
            added: Shape (A,): which markers of the message.

        Returns:
            Shape (A,): which may look different now.
        """
        changed = self._put(columns, rows, added)
        self._put_items(columns, rows, added)
        self._put_words(columns, rows, added)
        self._put_problems(columns, named, rows, added)
        return changed

    def forget(self, rows: Whole) -> None:
        """Markers are deleted: their points count no more."""
        self._points -= int(self._table.points[rows].sum())

    def _put(self, columns: MarkerColumns, rows: Whole, added: Whole) -> Flags:
        """Keep numbers of fixed count, and tell which markers may look different now."""
        table, types = self._table, columns.types[added]
        turns = unit_quaternions(columns.rotations_wxyz[added])[0]
        changed = (table.types[rows] != types) | np.isin(types, _WORDED) | (table.points[rows] > 0)
        changed |= columns.point_starts[added] != columns.point_starts[added + 1]
        for kept, new in (
            (table.positions, columns.positions[added]),
            (table.rotations_wxyz, turns),
            (table.scales, columns.scales[added]),
        ):
            changed |= (kept[rows] != new).any(axis=1)
            kept[rows] = new
        rgba = columns.colors_rgba[added]
        changed |= (table.rgba[rows] != rgba).any(axis=1)
        table.rgba[rows], table.types[rows] = rgba, types
        return changed

    def _put_items(self, columns: MarkerColumns, rows: Whole, added: Whole) -> None:
        """Copy points: views would keep whole messages in memory for the sake of one marker."""
        table = self._table
        begins, ends = columns.point_starts[added], columns.point_starts[added + 1]
        touched = np.flatnonzero((begins != ends) | (table.points[rows] > 0))
        rows, added = rows[touched], added[touched]
        self._points -= int(table.points[rows].sum())
        runs: list[list[int]] = np.stack(
            (
                rows, columns.types[added], begins[touched], ends[touched],
                columns.point_color_starts[added], columns.point_color_starts[added + 1],
            )
        ).T.tolist()  # fmt: skip
        counts: list[int] = []
        for row, *run in runs:
            items = _items_of(columns, *run, room=POINTS_MAX - self._points)
            table.items[row] = items
            counts.append(len(items.points))
            self._points += counts[-1]
        table.points[rows] = counts

    def _put_words(self, columns: MarkerColumns, rows: Whole, added: Whole) -> None:
        """Keep the texts and the addresses of meshes, whose troubles are found here."""
        types = columns.types[added]
        self._table.problems[rows] = Problem.NONE
        for kind in (Kind.TEXT, Kind.MESH):
            places = np.flatnonzero(types == kind)
            chosen: list[int] = added[places].tolist()
            of_rows: list[int] = rows[places].tolist()
            for row, at in zip(of_rows, chosen, strict=True):
                self._put_word(row, columns.texts[at], is_mesh=kind is Kind.MESH)

    def _put_word(self, row: int, said: MarkerTexts, *, is_mesh: bool) -> None:
        table = self._table
        word = table.words[row] = (said.mesh_resource if is_mesh else said.text)[:WORDS_MAX]
        table.embedded[row] = said.mesh_use_embedded_materials
        if is_mesh:
            if not word.startswith(_MESH_SCHEMES):
                table.problems[row] = _FOREIGN_MESH if word else _NO_MESH
        elif not word.strip():
            table.problems[row] = _EMPTY_TEXT

    def _put_problems(
        self, columns: MarkerColumns, named: Named, rows: Whole, added: Whole
    ) -> None:
        counts = np.diff(columns.point_starts)[added]
        colors = np.diff(columns.point_color_starts)[added]
        looked = Looked(
            columns.types[added], columns.scales[added], columns.colors_rgba[added, 3],
            counts, colors, named.nameless[added],
        )  # fmt: skip
        problems = np.maximum(problems_of(looked), self._table.problems[rows])
        problems[(counts > 0) & (self._table.points[rows] == 0)] = Problem.TOO_LARGE
        coloured: list[int] = np.flatnonzero(colors).tolist()
        for place in coloured:
            rgba = self._table.items[int(rows[place])].rgba
            if len(rgba) and not rgba[:, 3].any():
                problems[place] = max(int(problems[place]), _CLEAR)
        self._table.problems[rows] = problems


def _items_of(  # noqa: PLR0913 - numbers of one marker
    columns: MarkerColumns, kind: int, begin: int, end: int, first: int, last: int, *, room: int
) -> Items:
    """The points of a marker from `begin` on and its colours from `first` on, if there is room."""
    count = end - begin
    if not 0 < count <= room:
        return NO_ITEMS
    points = columns.points[begin:end].copy()
    if first == last or last - first not in _color_counts(kind, count):
        return Items(points, NO_ITEMS.rgba)
    return Items(points, np.nan_to_num(columns.point_colors_rgba[first:last]))


def _color_counts(kind: int, points: int) -> tuple[int, ...]:
    """How many colours make the points of a marker coloured; of triangles one each is enough."""
    if kind == Kind.TRIANGLES:
        return points, points // 3
    return (points,) if kind in COLOURED_POINTS else ()
