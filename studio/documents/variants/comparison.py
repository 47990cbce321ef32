"""Two states of a document compared: the presenter chooses them, and the result follows both."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.editing.variants import differing_names
from studio.description.values import SiteKind
from studio.documents.variants.second_robot import SecondRobot
from studio.errors import CommandError
from studio.protocol.listeners import encode
from studio.protocol.variants import Comparison, DifferenceView, InputDifference, Side, shown
from studio.robot.comparison import differences, whole_rows
from studio.robot.measures import measure

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Sequence

    from studio.documents.variants.recipes import Recipe, RecipeBook
    from studio.documents.variants.second_robot import Ghost, SecondRobots
    from studio.protocol.listeners import Audience
    from studio.robot.comparison import Row, Value
    from studio.robot.measures import Bounds, Measures


ROWS_SHOWN: Final = 1500
"""Limit of the differences listed; robots with more are not the same robot."""
_INPUTS_SHOWN: Final = 500


def robot_differences(
    one: SecondRobot, other: SecondRobot, mesh_bounds: Callable[[str], Bounds | None]
) -> tuple[DifferenceView, ...]:
    """Return the differences between two robots: of the whole, then part by part.

    Sizes are those at zero positions; `mesh_bounds` as for `measure`.
    """
    whole = whole_rows(_measured(one, mesh_bounds), _measured(other, mesh_bounds))
    rows = [("robot", row) for row in whole]
    rows += [(found.part, found.row) for found in differences(one.robot, other.robot)]
    return tuple(_view(part, row) for part, row in rows)


def input_differences(
    book: RecipeBook, one: SecondRobot, other: SecondRobot
) -> tuple[InputDifference, ...]:
    """Return the arguments that come to different values, and the texts that differ."""
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


_PRESENT = Side(kind="present")
_NOTHING = Comparison(sides=None, busy=False, faults=(), inputs=(), rows=(), count=0, ghost=None)


@dataclass(frozen=True, slots=True)
class _Made:
    """A side that was worked out, and what it was made from: arguments, texts, files on disk."""

    of: tuple[dict[str, str], dict[str, bytes], dict[str, bytes]]
    robot: SecondRobot


class VariantComparison:
    """Makes the robots to compare that are not the present one, and sends the differences.

    Args:
        book: Makes the recipes of states.
        robots: Makes the robot of a recipe.
        ghost: Shows one of them.
        audience: Is sent the differences.
        want_meshes: Called when the scene may lack meshes.
    """

    def __init__(
        self,
        book: RecipeBook,
        robots: SecondRobots,
        ghost: Ghost,
        audience: Audience,
        want_meshes: Callable[[], None],
    ) -> None:
        self._book, self._robots, self._ghost = book, robots, ghost
        self._audience, self._want_meshes = audience, want_meshes
        self._made: dict[Side, _Made] = {}
        self.sides: tuple[Side, Side] | None = None
        self.latest = _NOTHING
        """The event sent last."""

    @property
    def files(self) -> frozenset[str]:
        """Files that the robots were made from; a change on disk makes them again."""
        return frozenset(file for made in self._made.values() for file in made.robot.files)

    def choose(self, sides: tuple[Side, Side] | None) -> None:
        """Compare these from now on.

        Raises:
            CommandError: They are the same.
        """
        if sides is not None and sides[0] == sides[1]:
            raise CommandError("Both sides are the same: choose two different ones.")
        self.sides = sides

    def rename(self, old: str, new: str) -> None:
        """A variant has another name."""
        if self.sides:
            a, b = (_renamed(side, old, new) for side in self.sides)
            self.sides = (a, b)
        self._made = {_renamed(side, old, new): made for side, made in self._made.items()}

    def remake(self) -> None:
        """Take nothing for granted that was worked out: a file changed."""
        self._made.clear()

    async def follow(
        self, present: Callable[[], Awaitable[Recipe]], recipe_of: Callable[[Side], Recipe | None]
    ) -> None:
        """Bring everything up to date.

        Args:
            present: What the document is made of now.
            recipe_of: What another side is made of; None when it is no more.
        """
        if self.sides is None or not self._robots.has_present:
            await self._end()
            return
        sides, robots = self.sides, list[SecondRobot]()
        for side in sides:
            recipe = await present() if side == _PRESENT else recipe_of(side)
            if recipe is None:
                self.sides = None
                await self._end()
                return
            robots.append(await self._robot_of(side, recipe))
        self._made = {side: made for side, made in self._made.items() if side in sides}
        if self.sides == sides:  # else others were chosen meanwhile, and are compared next
            self._show(sides, *robots)

    async def close(self) -> None:
        """End the worker."""
        await self._robots.close()

    async def _end(self) -> None:
        if self.latest == _NOTHING:
            return
        self._made.clear()
        self._ghost.show(None, beside=False)
        await self._robots.close()
        self._send(_NOTHING)

    async def _robot_of(self, side: Side, recipe: Recipe) -> SecondRobot:
        if side == _PRESENT:
            return self._robots.present(recipe)
        overlay = self._book.overlay(recipe)
        made_of = recipe.arguments, overlay, self._book.disk()
        known = self._made.get(side)
        if known is None or known.of != made_of:
            self._send(self.latest.model_copy(update={"sides": self.sides, "busy": True}))
            robot = await self._robots.made(recipe, overlay)
            known = self._made[side] = _Made(made_of, robot)
        return known.robot

    def _show(self, sides: tuple[Side, Side], one: SecondRobot, other: SecondRobot) -> None:
        ghost = None
        if self._ghost.is_visible:
            ghost = sides[0] if sides[1] == _PRESENT else sides[1]
        second = one if ghost == sides[0] else other
        self._ghost.show(second if ghost else None, beside=self._ghost.is_beside)
        self._want_meshes()
        rows = robot_differences(one, other, self._ghost.mesh_bounds)
        self._send(
            Comparison(
                sides=sides,
                busy=False,
                faults=tuple(side.fault for side in (one, other) if side.fault),
                inputs=input_differences(self._book, one, other),
                rows=rows[:ROWS_SHOWN],
                count=len(rows),
                ghost=ghost,
            )
        )

    def _send(self, event: Comparison) -> None:
        if event != self.latest:
            self.latest = event
            # While somebody drags, a slow page need not have them all.
            self._audience.post(encode(event), key="comparison")


def _renamed(side: Side, old: str, new: str) -> Side:
    is_it = side.kind == "variant" and side.name == old
    return Side(kind="variant", name=new) if is_it else side
