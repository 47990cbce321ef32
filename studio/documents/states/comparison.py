"""Two states of a document compared: what differs in what they are made of, and in the robots."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from studio.description.editing.variants import differing_names
from studio.description.values import SiteKind
from studio.protocol.variants import DifferenceView, InputDifference, shown
from studio.robot.comparison import differences, whole_rows
from studio.robot.measures import measure

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.documents.states.recipes import RecipeBook
    from studio.documents.states.second_robot import SecondRobot
    from studio.robot.comparison import Row, Value
    from studio.robot.measures import Bounds, Measures

ROWS_SHOWN: Final = 1500
"""Of differences; robots that have more of them are not the same robot."""
_INPUTS_SHOWN: Final = 500


def robot_differences(
    one: SecondRobot, other: SecondRobot, mesh_bounds: Callable[[str], Bounds | None]
) -> tuple[DifferenceView, ...]:
    """All that differs between two robots: as a whole, then part by part.

    Sizes are those at zero positions; `mesh_bounds` as for `measure`.
    """
    whole = whole_rows(_measured(one, mesh_bounds), _measured(other, mesh_bounds))
    rows = [("robot", row) for row in whole]
    rows += [(found.part, found.row) for found in differences(one.robot, other.robot)]
    return tuple(_view(part, row) for part, row in rows)


def input_differences(
    book: RecipeBook, one: SecondRobot, other: SecondRobot
) -> tuple[InputDifference, ...]:
    """The arguments that come to different values, and the texts that differ."""
    return (*_argument_rows(one, other), *_text_rows(book, one, other))[:_INPUTS_SHOWN]


def _argument_rows(one: SecondRobot, other: SecondRobot) -> list[InputDifference]:
    passed = one.recipe.arguments, other.recipe.arguments
    found: list[InputDifference] = []
    for name in sorted(passed[0].keys() | passed[1].keys()):
        values = [
            side.recipe.arguments.get(name, side.arguments.get(name)) for side in (one, other)
        ]
        if values[0] != values[1]:
            found.append(_input(SiteKind.ARG, name, ("", 0), values))
    return found


def _text_rows(book: RecipeBook, one: SecondRobot, other: SecondRobot) -> list[InputDifference]:
    texts = one.recipe.texts, other.recipe.texts
    found: list[InputDifference] = []
    for name in differing_names(*texts):
        saved = book.saved_text(name)
        values = [side.get(name, saved) for side in texts]
        found.append(_input(name.kind, str(name), book.place_of(name), values))
    return found


def _input(
    kind: SiteKind, name: str, place: tuple[str, int], values: Sequence[str | None]
) -> InputDifference:
    one, other = (None if value is None else shown(value) for value in values)
    file, line = place
    return InputDifference(kind=kind, name=shown(name), file=file, line=line, one=one, other=other)


def _measured(side: SecondRobot, mesh_bounds: Callable[[str], Bounds | None]) -> Measures:
    kinematics = side.kinematics
    return measure(side.robot, kinematics, kinematics.zero_positions(), mesh_bounds)


def _view(part: str, row: Row) -> DifferenceView:
    delta, percent = _change(row.one, row.other)
    return DifferenceView(
        part=part,
        what=row.what,
        number=row.number,
        one=row.one,
        other=row.other,
        unit=row.unit,
        delta=delta,
        percent=percent,
    )


def _change(one: Value, other: Value) -> tuple[float | None, float | None]:
    """Absolute difference and per cent, of finite numbers."""
    if isinstance(one, str) or isinstance(other, str) or one is None or other is None:
        return None, None
    delta = other - one
    if not math.isfinite(delta):
        return None, None
    percent = 100 * delta / abs(one) if one else None
    return delta, percent if percent is not None and math.isfinite(percent) else None
