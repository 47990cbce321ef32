"""What keeps a marker from being seen, or from being seen whole, in RViz's words where it has some.

Each is a small number, so that a column can hold one for every marker.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

import numpy as np

from studio.displays.markers.kinds import COLOURED_POINTS, OF_POINTS, Kind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Reason
    from studio.displays.markers.kinds import Flags, Floats, Whole

_CLEAR_BELOW: Final = 0.5 / 255


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


class Said(NamedTuple):
    """How a problem is told."""

    level: Literal["warn", "error"]
    reason: Reason
    words: str


SAID: Final[dict[Problem, Said]] = {
    Problem.FLAT: Said("warn", "empty", "has a scale of 0 in x, y or z"),
    Problem.ANGULAR: Said(
        "warn", "unsupported", "has points of another height than width, which are drawn square"
    ),
    Problem.CLEAR: Said("warn", "transparent", "has an alpha of 0; set color.a to see it"),
    Problem.WIDTHLESS: Said("warn", "empty", "has a scale.x of 0, so that nothing of it is seen"),
    Problem.EMPTY_TEXT: Said("warn", "empty", "has no text"),
    Problem.HEIGHTLESS: Said("warn", "empty", "has a scale.z of 0, the height of its text"),
    Problem.FEW_POINTS: Said("warn", "no_points", "has too few points to show anything"),
    Problem.NO_FRAME: Said("error", "bad_message", "names no frame in its header"),
    Problem.ONE_POINT: Said("error", "no_points", "is an arrow from one point to nowhere"),
    Problem.ODD_POINTS: Said("error", "no_points", "is a line list of an odd number of points"),
    Problem.NOT_TRIPLE: Said(
        "error", "no_points", "is a triangle list whose points do not come in threes"
    ),
    Problem.NO_MESH: Said("error", "no_mesh", "names no mesh in mesh_resource"),
    Problem.FOREIGN_MESH: Said(
        "error", "no_mesh", "names a mesh that is neither a package:// nor a file:// address"
    ),
    Problem.UNKNOWN_TYPE: Said("error", "unsupported", "is of a type that does not exist"),
    Problem.NOT_FINITE: Said(
        "error", "not_finite", "holds numbers that are not finite or too large, and is left out"
    ),
    Problem.UNKNOWN_ACTION: Said("error", "bad_message", "asks for an action that does not exist"),
    Problem.TOO_MANY: Said("error", "unsupported", "is left out: there are too many at once"),
    Problem.TOO_LARGE: Said("error", "unsupported", "is left out: all have too many points"),
}


class Looked(NamedTuple):
    """The columns by which M markers are judged; each of shape (M,) but for the scales (M, 3)."""

    types: NDArray[np.int32]
    scales: Floats
    alphas: NDArray[np.float32]
    points: Whole
    """How many each has."""
    colors: Whole
    """How many each has."""
    nameless: Flags
    """Which name no frame."""


def problems_of(markers: Looked) -> NDArray[np.uint8]:
    """Judge markers by their numbers; of several problems the worst is told. Shape (M,)."""
    found = np.zeros(len(markers.types), dtype=np.uint8)
    for problem, holds in _all_of(markers):
        found[holds] = problem
    return found


def _all_of(markers: Looked) -> list[tuple[Problem, Flags]]:
    """Every problem and for which markers it holds, the worst at last."""
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
