"""TransformColumns: transforms as columns, as they come from the wire or from our own robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"
Numbers: TypeAlias = "NDArray[np.int64]"
Flags: TypeAlias = "NDArray[np.bool_]"


@dataclass(frozen=True, slots=True, eq=False)
class TransformColumns:
    """The transforms of one message, in its order; arrays that were read belong to nobody else.

    Attributes:
        parents: Of each the `header.frame_id`.
        children: Of each the `child_frame_id`.
        stamps_ns: Shape (N,), int64, since the epoch.
        translations: Shape (N, 3), float64, metres: the child's origin in the parent.
        rotations_wxyz: Shape (N, 4), float64, as they were sent, of whatever length.
    """

    parents: tuple[str, ...]
    children: tuple[str, ...]
    stamps_ns: Numbers
    translations: Floats
    rotations_wxyz: Floats
