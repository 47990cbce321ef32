"""AllFrames: all frames into one of them at once; the forest's shape is kept while it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.tf.forest import NONE
from studio.tf.frames_now import FramesNow
from studio.tf.rotations import IDENTITY, inverse_of, matrices_from_poses, poses_from_matrices
from studio.tf.shape import ForestShape

if TYPE_CHECKING:
    from studio.tf.arrivals import Arrivals
    from studio.tf.columns import Flags, Floats, Numbers
    from studio.tf.forest import Forest
    from studio.tf.histories import Histories
    from studio.tf.structure import Structure

_KEPT_MAX: Final = 8


class AllFrames:
    """Each edge is evaluated once, then products double; whoever asks holds the buffer's lock."""

    def __init__(self, forest: Forest, histories: Histories, arrivals: Arrivals) -> None:
        self._forest, self._histories, self._arrivals = forest, histories, arrivals
        self._version = forest.version
        self._shape = ForestShape(forest)
        self._frames = self._shape.numbers
        """The numbers of those that hang on one."""
        self._cut: dict[bytes, Structure] = {}
        self._turned: dict[int, tuple[Structure, Numbers]] = {}

    def seen_from(self, fixed: str, stamp_ns: int, now_ns: int) -> FramesNow:
        """See `TransformBuffer.all_in`."""
        shape = self.shape()
        row = shape.rows.get(fixed)
        if row is None:
            poses, connected, ages_s = self._nowhere()
        else:
            poses, connected = self._poses(row, stamp_ns)
            ages_s = self._ages_s(row, now_ns)
        parents = shape.structure.parents
        return FramesNow(fixed, shape.names, shape.rows, parents, poses, connected, ages_s)

    def _nowhere(self) -> tuple[Floats, Flags, Floats]:
        """Poses, connections and ages when nothing tells of the fixed frame."""
        count = len(self._shape.names)
        return np.tile(IDENTITY, (count, 1)), np.zeros(count, np.bool_), np.zeros(count)

    def _poses(self, row: int, stamp_ns: int) -> tuple[Floats, Flags]:
        """All poses in the frame of a row, and which are connected with it."""
        poses, known = self._edges(stamp_ns)
        structure = self._shape.structure if known.all() else self._without(~known)
        root_from = structure.root_from_rows(self._matrices(poses, structure))
        fixed_from = inverse_of(root_from[row]) @ root_from
        return poses_from_matrices(fixed_from), structure.roots == structure.roots[row]

    def shape(self) -> ForestShape:
        """The forest as it stands; the same object as long as no edge comes or goes."""
        if self._version != self._forest.version:
            self._version = self._forest.version
            self._shape = ForestShape(self._forest)
            self._frames = self._shape.numbers[self._shape.hung]
            self._cut.clear()
            self._turned.clear()
        return self._shape

    def _edges(self, stamp_ns: int) -> tuple[Floats, Flags]:
        """The poses of all frames that hang on one, and which of them are known then."""
        if stamp_ns == 0:
            return self._histories.newest(self._frames), np.ones(len(self._frames), np.bool_)
        return self._histories.at(self._frames, stamp_ns)

    def _matrices(self, poses: Floats, structure: Structure) -> Floats:
        matrices = np.empty((len(self._shape.names), 4, 4))
        matrices[self._shape.hung] = matrices_from_poses(poses)
        matrices[structure.parents == NONE] = np.eye(4)
        return matrices

    def _without(self, unknown: Flags) -> Structure:
        """The structure without edges that are not known at a time."""
        key = unknown.tobytes()
        if key not in self._cut:
            if len(self._cut) >= _KEPT_MAX:
                del self._cut[next(iter(self._cut))]
            cut = np.zeros(len(self._shape.names), np.bool_)
            cut[self._shape.hung] = unknown
            self._cut[key] = self._shape.structure.without(cut)
        return self._cut[key]

    def _ages_s(self, row: int, now_ns: int) -> Floats:
        if row not in self._turned:
            if len(self._turned) >= _KEPT_MAX:
                del self._turned[next(iter(self._turned))]
            self._turned[row] = self._shape.structure.seen_from(row)
        structure, edges = self._turned[row]
        numbers = self._shape.numbers
        moving = ~self._histories.is_static(numbers)
        ages_s = np.where(moving, self._arrivals.ages_s(numbers, now_ns), 0.0)[edges]
        ages_s[row] = 0.0
        return structure.greatest_above(ages_s)
