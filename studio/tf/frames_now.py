"""FramesNow: where all frames are in one of them, at one time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from studio.tf.forest import NONE
from studio.tf.rotations import IDENTITY, Pose

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.tf.columns import Flags, Floats, Numbers


@dataclass(frozen=True, slots=True, eq=False)
class FramesNow:
    """All F frames, seen from the fixed frame.

    Attributes:
        fixed: The name of the fixed frame.
        names: Of the frames; the same object as long as no edge comes or goes.
        rows: Where each name is in `names`.
        parents: Shape (F,): where the parent of each is in `names`; -1 for a root.
        wxyz_xyz: Shape (F, 7): unit quaternion and m; what is not connected has any.
        connected: Shape (F,): whether transforms lead from each to the fixed frame at that time.
        ages_s: Shape (F,): how long the most silent transform on that way has not come; static
            ones are never old.
    """

    fixed: str
    names: tuple[str, ...]
    rows: Mapping[str, int]
    parents: Numbers
    wxyz_xyz: Floats
    connected: Flags
    ages_s: Floats

    def pose_of(self, frame: str) -> Pose | None:
        """The pose of a frame in the fixed frame; None when it is not connected."""
        row = self.rows.get(frame)
        if row is None or not self.connected[row]:
            return IDENTITY if frame == self.fixed else None
        w, x, y, z, px, py, pz = self.wxyz_xyz[row].tolist()
        return w, x, y, z, px, py, pz

    def root_of_most(self) -> str:
        """The root of the largest tree, of several the first by name; empty without any frame."""
        if not self.names:
            return ""
        reached = np.where(self.parents == NONE, np.arange(len(self.names)), self.parents)
        while (further := reached[reached]).tobytes() != reached.tobytes():
            reached = further
        counts = np.bincount(reached)
        return min(self.names[row] for row in np.flatnonzero(counts == counts.max()).tolist())
