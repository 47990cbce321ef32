"""The numbers of a visualization_msgs/Marker by name, and what can be wrong with one."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Reason

Floats: TypeAlias = "NDArray[np.float64]"
Flags: TypeAlias = "NDArray[np.bool_]"
Whole: TypeAlias = "NDArray[np.intp]"
_CLEAR_BELOW: Final = 0.5 / 255
Key: TypeAlias = tuple[str, int]
"""Namespace and id of a marker."""


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
"""Types that show nothing without points."""
COLOURED_POINTS: Final = (
    Kind.LINE_STRIP, Kind.LINE_LIST, Kind.CUBE_LIST, Kind.SPHERE_LIST, Kind.POINTS, Kind.TRIANGLES,
)  # fmt: skip
"""Types whose points may have colours of their own."""


class Problem(IntEnum):
    """What is wrong with a marker; from `NO_FRAME` on it is not drawn."""

    NONE = 0
    FLAT = 1
    ANGULAR = 2
    CLEAR = 3
    WIDTHLESS = 4
    EMPTY_TEXT = 5
    HEIGHTLESS = 6
    FEW_POINTS = 7
    NO_FRAME = 8
    ONE_POINT = 9
    ODD_POINTS = 10
    NOT_TRIPLE = 11
    NO_MESH = 12
    FOREIGN_MESH = 13
    UNKNOWN_TYPE = 14
    NOT_FINITE = 15
    UNKNOWN_ACTION = 16
    TOO_MANY = 17
    TOO_LARGE = 18


NOT_DRAWN: Final = Problem.NO_FRAME


class Sentence(NamedTuple):
    """How a problem is reported."""

    level: Literal["warn", "error"]
    reason: Reason
    text: str


SENTENCES: Final[dict[Problem, Sentence]] = {
    Problem.FLAT: Sentence("warn", "empty", "has a scale of 0 in x, y or z"),
    Problem.ANGULAR: Sentence(
        "warn", "unsupported", "has points of another height than width, which are drawn square"
    ),
    Problem.CLEAR: Sentence("warn", "transparent", "has an alpha of 0; set color.a to see it"),
    Problem.WIDTHLESS: Sentence(
        "warn", "empty", "has a scale.x of 0, so that nothing of it is seen"
    ),
    Problem.EMPTY_TEXT: Sentence("warn", "empty", "has no text"),
    Problem.HEIGHTLESS: Sentence("warn", "empty", "has a scale.z of 0, the height of its text"),
    Problem.FEW_POINTS: Sentence("warn", "no_points", "has too few points to show anything"),
    Problem.NO_FRAME: Sentence("error", "bad_message", "names no frame in its header"),
    Problem.ONE_POINT: Sentence("error", "no_points", "is an arrow from one point to nowhere"),
    Problem.ODD_POINTS: Sentence("error", "no_points", "is a line list of an odd number of points"),
    Problem.NOT_TRIPLE: Sentence(
        "error", "no_points", "is a triangle list whose points do not come in threes"
    ),
    Problem.NO_MESH: Sentence("error", "no_mesh", "names no mesh in mesh_resource"),
    Problem.FOREIGN_MESH: Sentence(
        "error", "no_mesh", "names a mesh that is neither a package:// nor a file:// address"
    ),
    Problem.UNKNOWN_TYPE: Sentence("error", "unsupported", "is of a type that does not exist"),
    Problem.NOT_FINITE: Sentence(
        "error", "not_finite", "holds numbers that are not finite or too large, and is left out"
    ),
    Problem.UNKNOWN_ACTION: Sentence(
        "error", "bad_message", "asks for an action that does not exist"
    ),
    Problem.TOO_MANY: Sentence("error", "unsupported", "is left out: there are too many at once"),
    Problem.TOO_LARGE: Sentence("error", "unsupported", "is left out: all have too many points"),
}


class Columns(NamedTuple):
    """The columns of M markers that are checked; each of shape (M,) but for the scales (M, 3)."""

    types: NDArray[np.int32]
    scales: Floats
    alphas: NDArray[np.float32]
    points: Whole
    """Number of points of each."""
    colors: Whole
    """Number of colours of each."""
    nameless: Flags
    """Whether each lacks a frame."""


def problems_of(markers: Columns) -> NDArray[np.uint8]:
    """Return the worst problem of each marker by its numbers, shape (M,)."""
    found = np.zeros(len(markers.types), dtype=np.uint8)
    for problem, holds in _all_of(markers):
        found[holds] = problem
    return found


def _all_of(markers: Columns) -> list[tuple[Problem, Flags]]:
    """Return every problem and for which markers it holds, the worst at last."""
    types, scales, points = markers.types, markers.scales, markers.points
    is_arrow = types == Kind.ARROW
    # As RViz has it: points are between both ends only if there are two of them.
    by_points = (is_arrow & (points == 2)) | (types == Kind.ARROW_STRIP)
    by_width = (types == Kind.LINE_STRIP) | (types == Kind.LINE_LIST)
    is_text, is_dots, is_mesh = types == Kind.TEXT, types == Kind.POINTS, types == Kind.MESH
    is_solid = ~(by_points | by_width | is_text | is_dots)
    least = np.where(types == Kind.LINE_STRIP, 2, 1)
    least[types == Kind.ARROW_STRIP] = 2
    own_colors = np.isin(types, COLOURED_POINTS) & (markers.colors > 0)
    return [
        (Problem.ANGULAR, is_dots & (scales[:, 0] != scales[:, 1])),
        (Problem.FLAT, is_solid & (scales == 0).any(axis=1)),
        (Problem.FLAT, by_points & (scales[:, :2] == 0).all(axis=1)),
        (Problem.CLEAR, (markers.alphas < _CLEAR_BELOW) & ~own_colors & ~is_mesh),
        (Problem.WIDTHLESS, (by_width | is_dots) & (scales[:, 0] == 0)),
        (Problem.HEIGHTLESS, is_text & (scales[:, 2] == 0)),
        (Problem.FEW_POINTS, np.isin(types, OF_POINTS) & (points < least)),
        (Problem.ONE_POINT, is_arrow & (points == 1)),
        (Problem.ODD_POINTS, (types == Kind.LINE_LIST) & (points % 2 == 1)),
        (Problem.NOT_TRIPLE, (types == Kind.TRIANGLES) & (points % 3 != 0)),
        (Problem.NO_FRAME, markers.nameless),
        (Problem.UNKNOWN_TYPE, (types < Kind.ARROW) | (types > Kind.ARROW_STRIP)),
    ]
