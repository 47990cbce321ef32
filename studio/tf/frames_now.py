"""FramesNow: where all frames are in one of them, at one time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.tf.columns import Flags, Floats, Numbers


@dataclass(frozen=True, slots=True, eq=False)
class FramesNow:
    """All F frames, seen from the fixed frame.

    Attributes:
        fixed: The name of the fixed frame.
        names: Of the frames; the same object as long as no edge comes or goes.
        parents: Shape (F,): where the parent of each is in `names`; -1 for a root.
        wxyz_xyz: Shape (F, 7): unit quaternion and m; what is not connected has any.
        connected: Shape (F,): whether transforms lead from each to the fixed frame at that time.
        ages_s: Shape (F,): how long the most silent transform on that way has not come; static
            ones are never old.
    """

    fixed: str
    names: tuple[str, ...]
    parents: Numbers
    wxyz_xyz: Floats
    connected: Flags
    ages_s: Floats
