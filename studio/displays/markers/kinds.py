"""What the numbers of a visualization_msgs/Marker stand for."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Final, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"
Flags: TypeAlias = "NDArray[np.bool_]"
Whole: TypeAlias = "NDArray[np.intp]"


class Kind(IntEnum):
    """Field `type`."""

    ARROW = 0
    CUBE = 1
    SPHERE = 2
    CYLINDER = 3
    LINE_STRIP = 4
    LINE_LIST = 5
    CUBE_LIST = 6
    SPHERE_LIST = 7
    POINTS = 8
    TEXT = 9
    MESH = 10
    TRIANGLES = 11
    ARROW_STRIP = 12


class Action(IntEnum):
    """Field `action`; 1 is left free by the specification."""

    ADD = 0
    DELETE = 2
    DELETE_ALL = 3


OF_POINTS: Final = (
    Kind.LINE_STRIP, Kind.LINE_LIST, Kind.CUBE_LIST, Kind.SPHERE_LIST, Kind.POINTS, Kind.TRIANGLES,
    Kind.ARROW_STRIP,
)  # fmt: skip
"""Those that show nothing without points."""
COLOURED_POINTS: Final = (
    Kind.LINE_STRIP, Kind.LINE_LIST, Kind.CUBE_LIST, Kind.SPHERE_LIST, Kind.POINTS, Kind.TRIANGLES,
)  # fmt: skip
"""Those whose points may have colours of their own."""
