"""The poses of all frames in one of them, at one time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.tf.forest import NONE, ForestShape
from studio.tf.rotations import IDENTITY, Pose, inverse_of, matrices_from_poses, poses_from_matrices

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.tf.arrivals import Arrivals
    from studio.tf.forest import Forest, Structure
    from studio.tf.histories import Histories
    from studio.tf.transforms import Flags, Floats, Numbers

_KEPT_MAX: Final = 8


@dataclass(frozen=True, slots=True, eq=False)
class FramesNow:
    """All F frames, seen from the fixed frame.

    Attributes:
        fixed: The name of the fixed frame.
        names: The frames' names; the same object as long as no edge comes or goes.
        rows: Index of each name in `names`.
        parents: Shape (F,): index of each parent in `names`; -1 for a root.
        wxyz_xyz: Shape (F, 7): unit quaternion and m; undefined for what is not connected.
        connected: Shape (F,): whether transforms lead from each to the fixed frame at that time.
        ages_s: Shape (F,): the age of the oldest transform on that chain; static ones have none.
    """

    fixed: str
    names: tuple[str, ...]
    rows: Mapping[str, int]
    parents: Numbers
    wxyz_xyz: Floats
    connected: Flags
    ages_s: Floats

    def pose_of(self, frame: str) -> Pose | None:
        """Return the pose of a frame in the fixed frame; None when it is not connected."""
        row = self.rows.get(frame)
        if row is None or not self.connected[row]:
            return IDENTITY if frame == self.fixed else None
        w, x, y, z, px, py, pz = self.wxyz_xyz[row].tolist()
        return w, x, y, z, px, py, pz

    def root_of_most(self) -> str:
        """Return the root of the largest tree, the first by name; empty without any frame."""
        if not self.names:
            return ""
        reached = np.where(self.parents == NONE, np.arange(len(self.names)), self.parents)
        while (further := reached[reached]).tobytes() != reached.tobytes():
            reached = further
        counts = np.bincount(reached)
        return min(self.names[row] for row in np.flatnonzero(counts == counts.max()).tolist())


class AllFrames:
    """Evaluates each edge once and multiplies in doubling steps, under the lock of the buffer."""

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
        """Return poses, connections and ages when the fixed frame is unknown."""
        count = len(self._shape.names)
        return np.tile(IDENTITY, (count, 1)), np.zeros(count, np.bool_), np.zeros(count)

    def _poses(self, row: int, stamp_ns: int) -> tuple[Floats, Flags]:
        """Return all poses in the frame of a row, and which are connected with it."""
        poses, known = self._edges(stamp_ns)
        structure = self._shape.structure if known.all() else self._without(~known)
        root_from = structure.root_from_rows(self._matrices(poses, structure))
        fixed_from = inverse_of(root_from[row]) @ root_from
        return poses_from_matrices(fixed_from), structure.roots == structure.roots[row]

    def shape(self) -> ForestShape:
        """Return the forest as arrays; the same object as long as no edge comes or goes."""
        if self._version != self._forest.version:
            self._version = self._forest.version
            self._shape = ForestShape(self._forest)
            self._frames = self._shape.numbers[self._shape.hung]
            self._cut.clear()
            self._turned.clear()
        return self._shape

    def _edges(self, stamp_ns: int) -> tuple[Floats, Flags]:
        """Return the poses of all frames that hang on one, and which of them are known then."""
        if stamp_ns == 0:
            return self._histories.newest(self._frames), np.ones(len(self._frames), np.bool_)
        return self._histories.at(self._frames, stamp_ns)

    def _matrices(self, poses: Floats, structure: Structure) -> Floats:
        matrices = np.empty((len(self._shape.names), 4, 4))
        matrices[self._shape.hung] = matrices_from_poses(poses)
        matrices[structure.parents == NONE] = np.eye(4)
        return matrices

    def _without(self, unknown: Flags) -> Structure:
        """Return the structure without edges that are not known at a time."""
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
