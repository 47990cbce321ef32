"""AllFrames: all frames into one of them at once; the forest's shape is kept while it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.tf.forest import NONE
from studio.tf.frames_now import FramesNow
from studio.tf.rotations import IDENTITY, inverse_of, matrices_from_poses, poses_from_matrices
from studio.tf.structure import Structure

if TYPE_CHECKING:
    from studio.tf.arrivals import Arrivals
    from studio.tf.columns import Flags, Floats, Numbers
    from studio.tf.forest import Forest
    from studio.tf.histories import Histories

_KEPT_MAX: Final = 8


class AllFrames:
    """Each edge is evaluated once, then products double; whoever asks holds the buffer's lock."""

    def __init__(self, forest: Forest, histories: Histories, arrivals: Arrivals) -> None:
        self._forest, self._histories, self._arrivals = forest, histories, arrivals
        self._version = -1
        self._names: tuple[str, ...] = ()
        self._rows: dict[str, int] = {}
        self._numbers: Numbers = np.zeros(0, np.int64)
        """Of the forest, row by row."""
        self._hung: Numbers = self._numbers
        """Rows that hang on one."""
        self._frames: Numbers = self._numbers
        """The numbers of those."""
        self._structure = Structure(self._hung)
        self._cut: dict[bytes, Structure] = {}
        self._turned: dict[int, tuple[Structure, Numbers]] = {}

    def seen_from(self, fixed: str, stamp_ns: int, now_ns: int) -> FramesNow:
        """See `TransformBuffer.all_in`."""
        self._follow_forest()
        row = self._rows.get(fixed)
        if row is None:
            poses, connected, ages_s = self._nowhere()
        else:
            poses, connected = self._poses(row, stamp_ns)
            ages_s = self._ages_s(row, now_ns)
        parents = self._structure.parents
        return FramesNow(fixed, self._names, self._rows, parents, poses, connected, ages_s)

    def _nowhere(self) -> tuple[Floats, Flags, Floats]:
        """Poses, connections and ages when nothing tells of the fixed frame."""
        count = len(self._names)
        return np.tile(IDENTITY, (count, 1)), np.zeros(count, np.bool_), np.zeros(count)

    def _poses(self, row: int, stamp_ns: int) -> tuple[Floats, Flags]:
        """All poses in the frame of a row, and which are connected with it."""
        poses, known = self._edges(stamp_ns)
        structure = self._structure if known.all() else self._without(~known)
        root_from = structure.root_from_rows(self._matrices(poses, structure))
        fixed_from = inverse_of(root_from[row]) @ root_from
        return poses_from_matrices(fixed_from), structure.roots == structure.roots[row]

    def tree_sizes(self) -> dict[str, int]:
        """How many frames each tree has, by its root, from the most."""
        self._follow_forest()
        counts = np.bincount(self._structure.roots).tolist()
        sizes = {self._names[row]: int(count) for row, count in enumerate(counts) if count}
        return dict(sorted(sizes.items(), key=lambda one: (-one[1], one[0])))

    def _follow_forest(self) -> None:
        if self._version == self._forest.version:
            return
        self._version = self._forest.version
        numbers = self._forest.numbers()
        self._numbers = np.array(numbers, np.int64)
        self._names = tuple(self._forest.names[number] for number in numbers)
        self._rows = {name: row for row, name in enumerate(self._names)}
        parents = np.array(self._forest.parents, np.int64)[self._numbers]
        rows = np.searchsorted(self._numbers, parents)
        self._structure = Structure(np.where(parents == NONE, NONE, rows))
        self._hung = np.flatnonzero(parents != NONE)
        self._frames = self._numbers[self._hung]
        self._cut.clear()
        self._turned.clear()

    def _edges(self, stamp_ns: int) -> tuple[Floats, Flags]:
        """The poses of all frames that hang on one, and which of them are known then."""
        if stamp_ns == 0:
            return self._histories.newest(self._frames), np.ones(len(self._frames), np.bool_)
        return self._histories.at(self._frames, stamp_ns)

    def _matrices(self, poses: Floats, structure: Structure) -> Floats:
        matrices = np.empty((len(self._names), 4, 4))
        matrices[self._hung] = matrices_from_poses(poses)
        matrices[structure.parents == NONE] = np.eye(4)
        return matrices

    def _without(self, unknown: Flags) -> Structure:
        """The structure without edges that are not known at a time."""
        key = unknown.tobytes()
        if key not in self._cut:
            if len(self._cut) >= _KEPT_MAX:
                del self._cut[next(iter(self._cut))]
            cut = np.zeros(len(self._names), np.bool_)
            cut[self._hung] = unknown
            self._cut[key] = self._structure.without(cut)
        return self._cut[key]

    def _ages_s(self, row: int, now_ns: int) -> Floats:
        if row not in self._turned:
            if len(self._turned) >= _KEPT_MAX:
                del self._turned[next(iter(self._turned))]
            self._turned[row] = self._structure.seen_from(row)
        structure, edges = self._turned[row]
        moving = ~self._histories.is_static(self._numbers)
        ages_s = np.where(moving, self._arrivals.ages_s(self._numbers, now_ns), 0.0)[edges]
        ages_s[row] = 0.0
        return structure.greatest_above(ages_s)
