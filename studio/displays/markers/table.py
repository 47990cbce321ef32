"""MarkerTable: one row for each marker that exists, as columns that grow, filled from messages."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple, TypeVar

import numpy as np

from studio.displays.markers.kinds import (
    COLOURED_POINTS,
    NOT_DRAWN,
    Columns,
    Kind,
    Problem,
    problems_of,
)
from studio.displays.turning import unit_quaternions

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from studio.displays.markers.kinds import Flags, Floats, Key, Whole
    from studio.ros.columns.markers import MarkerColumns, MarkerTexts

FOR_EVER: Final = np.iinfo(np.int64).max
NO_BATCH: Final = -1
_ROWS_AT_FIRST: Final = 64
_NOBODY: Final = ("", 0)
N = TypeVar("N", bound=np.generic)
POINTS_MAX: Final = 2_000_000
TEXT_MAX: Final = 2000
_MESH_SCHEMES: Final = ("package://", "file://")
_WORDED: Final = np.array([Kind.TEXT, Kind.MESH], dtype=np.int32)
# Members of an IntEnum are slow to look up in a loop.
_CLEAR, _EMPTY_TEXT = int(Problem.CLEAR), int(Problem.EMPTY_TEXT)
_NO_MESH, _FOREIGN_MESH = int(Problem.NO_MESH), int(Problem.FOREIGN_MESH)


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
        rows: Shape (M,): their rows of the table.
        types: Shape (M,), int32.
        positions: Shape (M, 3), m in the frame.
        rotations_wxyz: Shape (M, 4), of length 1.
        scales: Shape (M, 3), as sent.
        rgba: Shape (M, 4), 0 to 1 or beyond.
        items: Of each.
        texts: Text of each, or the URI of its mesh.
        embedded: Shape (M,): whether a mesh uses its own colours.
    """

    rows: Whole
    types: NDArray[np.int32]
    positions: Floats
    rotations_wxyz: Floats
    scales: Floats
    rgba: NDArray[np.float32]
    items: tuple[Items, ...]
    texts: tuple[str, ...]
    embedded: NDArray[np.bool_]

    def only(self, chosen: NDArray[np.bool_]) -> Rows:
        """Return those for which `chosen` (M,) holds."""
        if chosen.all():
            return self
        places = np.flatnonzero(chosen)
        kept: list[int] = places.tolist()
        return Rows(
            self.rows[places], self.types[places], self.positions[places],
            self.rotations_wxyz[places], self.scales[places], self.rgba[places],
            tuple([self.items[place] for place in kept]),
            tuple([self.texts[place] for place in kept]),
            self.embedded[places],
        )  # fmt: skip

    def part(self, begin: int, end: int) -> Rows:
        """Return those from `begin` to before `end`, as views."""
        run = slice(begin, end)
        return Rows(
            self.rows[run], self.types[run], self.positions[run], self.rotations_wxyz[run],
            self.scales[run], self.rgba[run], self.items[run], self.texts[run],
            self.embedded[run],
        )  # fmt: skip

    def of_types(self, *types: int) -> Rows:
        """Return those of some types."""
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
        self._points_in_all = 0
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
        self.texts: list[str] = [""] * _ROWS_AT_FIRST
        self.keys: list[Key] = [_NOBODY] * _ROWS_AT_FIRST
        self._free: list[int] = []

    def take_row(self, key: Key) -> int:
        """Return the first free row, so that markers in the same order get the same rows."""
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
            self._points_in_all -= int(self.points[row])
            self.batch[row] = NO_BATCH
            self.expires_ns[row] = FOR_EVER
            self.problems[row], self.points[row] = Problem.NONE, 0
            self.items[row], self.texts[row], self.keys[row] = NO_ITEMS, "", _NOBODY
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
            tuple([self.texts[row] for row in chosen]),
            self.embedded[rows],
        )  # fmt: skip

    def fill(self, columns: MarkerColumns, nameless: Flags, rows: Whole, added: Whole) -> Flags:
        """Write markers into their rows.

        Args:
            columns: The markers of a message.
            nameless: Shape (M,): which markers of the message have no frame.
            rows: Shape (A,), all different.
            added: Shape (A,): which markers of the message to write.

        Returns:
            Shape (A,): which may look different now.
        """
        changed = self._put(columns, rows, added)
        self._put_items(columns, rows, added)
        self._put_texts(columns, rows, added)
        self._put_problems(columns, nameless, rows, added)
        return changed

    def _put(self, columns: MarkerColumns, rows: Whole, added: Whole) -> Flags:
        """Store the numbers of fixed count; return which markers may look different now."""
        types = columns.types[added]
        turns = unit_quaternions(columns.rotations_wxyz[added])[0]
        changed = (self.types[rows] != types) | np.isin(types, _WORDED) | (self.points[rows] > 0)
        changed |= columns.point_starts[added] != columns.point_starts[added + 1]
        for kept, new in (
            (self.positions, columns.positions[added]),
            (self.rotations_wxyz, turns),
            (self.scales, columns.scales[added]),
        ):
            changed |= (kept[rows] != new).any(axis=1)
            kept[rows] = new
        rgba = columns.colors_rgba[added]
        changed |= (self.rgba[rows] != rgba).any(axis=1)
        self.rgba[rows], self.types[rows] = rgba, types
        return changed

    def _put_items(self, columns: MarkerColumns, rows: Whole, added: Whole) -> None:
        """Copy points: views would keep whole messages in memory for the sake of one marker."""
        begins, ends = columns.point_starts[added], columns.point_starts[added + 1]
        touched = np.flatnonzero((begins != ends) | (self.points[rows] > 0))
        rows, added = rows[touched], added[touched]
        self._points_in_all -= int(self.points[rows].sum())
        runs: list[list[int]] = np.stack(
            (
                rows, columns.types[added], begins[touched], ends[touched],
                columns.point_color_starts[added], columns.point_color_starts[added + 1],
            )
        ).T.tolist()  # fmt: skip
        counts: list[int] = []
        for row, *run in runs:
            items = _items_of(columns, *run, room=POINTS_MAX - self._points_in_all)
            self.items[row] = items
            counts.append(len(items.points))
            self._points_in_all += counts[-1]
        self.points[rows] = counts

    def _put_texts(self, columns: MarkerColumns, rows: Whole, added: Whole) -> None:
        """Store texts and addresses of meshes, and what is wrong with them."""
        types = columns.types[added]
        self.problems[rows] = Problem.NONE
        for kind in (Kind.TEXT, Kind.MESH):
            places = np.flatnonzero(types == kind)
            chosen: list[int] = added[places].tolist()
            of_rows: list[int] = rows[places].tolist()
            for row, at in zip(of_rows, chosen, strict=True):
                self._put_text(row, columns.texts[at], is_mesh=kind is Kind.MESH)

    def _put_text(self, row: int, texts: MarkerTexts, *, is_mesh: bool) -> None:
        text = self.texts[row] = (texts.mesh_resource if is_mesh else texts.text)[:TEXT_MAX]
        self.embedded[row] = texts.mesh_use_embedded_materials
        if is_mesh:
            if not text.startswith(_MESH_SCHEMES):
                self.problems[row] = _FOREIGN_MESH if text else _NO_MESH
        elif not text.strip():
            self.problems[row] = _EMPTY_TEXT

    def _put_problems(
        self, columns: MarkerColumns, nameless: Flags, rows: Whole, added: Whole
    ) -> None:
        counts = np.diff(columns.point_starts)[added]
        colors = np.diff(columns.point_color_starts)[added]
        numbers = Columns(
            columns.types[added], columns.scales[added], columns.colors_rgba[added, 3],
            counts, colors, nameless[added],
        )  # fmt: skip
        problems = np.maximum(problems_of(numbers), self.problems[rows])
        problems[(counts > 0) & (self.points[rows] == 0)] = Problem.TOO_LARGE
        coloured: list[int] = np.flatnonzero(colors).tolist()
        for place in coloured:
            rgba = self.items[int(rows[place])].rgba
            if len(rgba) and not rgba[:, 3].any():
                problems[place] = max(int(problems[place]), _CLEAR)
        self.problems[rows] = problems

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
        self.texts += [""] * more
        self.keys += [_NOBODY] * more


def _doubled(column: NDArray[N]) -> NDArray[N]:
    return np.concatenate((column, np.zeros_like(column)))


def _items_of(  # noqa: PLR0913 - numbers of one marker
    columns: MarkerColumns, kind: int, begin: int, end: int, first: int, last: int, *, room: int
) -> Items:
    """Return a marker's points from `begin` and colours from `first` on, if there is room."""
    count = end - begin
    if not 0 < count <= room:
        return NO_ITEMS
    points = columns.points[begin:end].copy()
    if first == last or last - first not in _color_counts(kind, count):
        return Items(points, NO_ITEMS.rgba)
    return Items(points, np.nan_to_num(columns.point_colors_rgba[first:last]))


def _color_counts(kind: int, points: int) -> tuple[int, ...]:
    """Return how many colours colour each point of a marker; for triangles one each is enough."""
    if kind == Kind.TRIANGLES:
        return points, points // 3
    return (points,) if kind in COLOURED_POINTS else ()
