"""What is found wrong with a document's texts and its robot, told on the board, fixes included."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.description.values import Checked, CheckQuery, ReadRobot
from studio.errors import CommandError
from studio.problems import Fix, Problem
from studio.protocol.roles import Role
from studio.robot.assembly import Assembly

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterable, Sequence

    from studio.description.values import Expansion, Failure, Part
    from studio.documents.document import Document
    from studio.documents.services import Services


_VALIDATE_AFTER_S: Final = 0.3
"""Quiet time after a structural change before yourdfpy is asked for its opinion."""
_XML: Final = "xml-"
"""How the codes of broken texts begin: a run tells them itself."""

_log = logging.getLogger(__name__)


class TextChecks:
    """Tells what runs found at once, and what the checks of the texts find when it is quiet.

    It asks the worker as a viewer does, so that whoever edits is answered first.
    """

    role = Role.VIEWER
    person = ""

    def __init__(self, document: Document, services: Services) -> None:
        self._document, self._validator = document, services.validator
        self._quiet_s, self._patience_s = services.quiet_s, services.patience_s
        self._of_robot: tuple[Problem, ...] = ()
        self._of_texts: tuple[Problem, ...] = ()
        self._second_opinion: tuple[Problem, ...] = ()
        self._looking: asyncio.Task[None] | None = None
        self._validating: asyncio.Task[None] | None = None

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Nothing is sent to it: answers come from where it asks."""

    def failed(self, failure: Failure) -> None:
        """A run gave no robot."""
        first, *others = failure.problems or (failure.problem,)
        self._document.board.find("expansion", (self._with_undo(first), *others))
        self.doubt()

    def expanded(
        self, expansion: Expansion, of_robot: tuple[Problem, ...], *, structural: bool
    ) -> None:
        """A run gave a robot, with these problems."""
        self._document.board.find("expansion", expansion.warnings)
        self._of_robot = of_robot
        self._tell()
        if structural:
            self._validating = self._instead(self._validating, self._validate())
        self.doubt()

    def doubt(self) -> None:
        """The texts are other ones: look at them when it has been quiet for a while."""
        self._looking = self._instead(self._looking, self._look_later())

    async def settled(self) -> None:
        """Wait until the texts as they are now were looked at, by yourdfpy too."""
        while under_way := self._under_way():
            await asyncio.wait(under_way)

    async def close(self) -> None:
        """Look no more."""
        under_way = self._under_way()
        for task in under_way:
            task.cancel()
        await asyncio.gather(*under_way, return_exceptions=True)

    def _under_way(self) -> set[asyncio.Task[None]]:
        tasks = (self._looking, self._validating)
        return {task for task in tasks if task is not None and not task.done()}

    @staticmethod
    def _instead(
        before: asyncio.Task[None] | None, work: Coroutine[None, None, None]
    ) -> asyncio.Task[None]:
        if before is not None:
            before.cancel()
        return asyncio.create_task(work)

    async def _look_later(self) -> None:
        await self._document.opened(self._patience_s)
        await asyncio.sleep(self._quiet_s)
        try:
            await self._take(await self._document.ask(CheckQuery(), Checked, self))
        except CommandError:
            return  # what was found last stands until there is a robot again
        except Exception:  # noqa: BLE001 - the checks of one text may not end those of the next
            _log.exception("The checks of %s failed.", self._document.path)

    async def _take(self, checked: Checked) -> None:
        of_robot = checked.read and await asyncio.to_thread(_problems_of, checked.read)
        self._of_texts = tuple(one for one in checked.problems if not one.code.startswith(_XML))
        if of_robot is not None and self._document.failed:
            self._of_robot = of_robot
        self._tell()

    def _tell(self) -> None:
        board, found = self._document.board, merged(self._of_robot, self._of_texts)
        board.find("robot", found)
        codes = {one.code for one in found}
        more = [one for one in self._second_opinion if one.code not in codes]
        board.find("validation", more if codes.isdisjoint(_EXPLAIN) else ())

    async def _validate(self) -> None:
        await self._document.opened(self._patience_s)
        await asyncio.sleep(min(_VALIDATE_AFTER_S, self._quiet_s))
        found = await self._validator.validate(await self._document.urdf())
        part = self._document.model.assembly.part
        self._second_opinion = tuple(placed(one, part) for one in found)
        self._tell()

    def _with_undo(self, problem: Problem) -> Problem:
        """Offer to give what is missing, or to take the edit back that may have broken it."""
        document = self._document
        if problem.fix:
            return problem
        if problem.code == "undefined-argument" and document.expansion is None:
            return replace(problem, fix=Fix("Give it a value", "give_arguments"))
        if not document.sources.undo_labels or document.expansion is None:
            return problem
        return replace(problem, fix=Fix("Undo edit", "undo"))


_EXPLAIN: Final = frozenset(
    {
        *("bad-element", "cycle", "dangling-child", "dangling-parent", "duplicate-joint"),
        *("duplicate-link", "no-links", "second-parent", "several-roots"),
    }
)
"""Codes of what makes yourdfpy fall as well: what it says of it then helps nobody."""
_OF_BOTH: Final = frozenset(
    {
        *("bad-element", "dangling-parent", "dangling-child", "duplicate-joint", "duplicate-link"),
        *("second-parent", "several-roots"),
    }
)
"""Codes of what the robot's structure and the texts tell; the texts know the place and a fix."""


def merged(of_robot: Iterable[Problem], of_texts: Sequence[Problem]) -> tuple[Problem, ...]:
    """Each fact once: as the robot tells it, with what the texts know of it.

    What the texts tell of the robot's structure holds only while the robot tells it, too.
    """
    better = {_fact(one): one for one in of_texts if one.code in _OF_BOTH}
    found = [replace(better.get(_fact(one), one), severity=one.severity) for one in of_robot]
    return (*found, *(one for one in of_texts if one.code not in _OF_BOTH))


def placed(problem: Problem, part: Callable[[str], Part | None]) -> Problem:
    """A problem of a part of the robot, at the place where that is written."""
    found = part(problem.parts[0]) if problem.parts else None
    return replace(problem, place=found.place, macro_stack=found.calls) if found else problem


def _fact(problem: Problem) -> tuple[str, tuple[str, ...]]:
    """What a finding is about; of the roots there is one finding, of an element there are many."""
    match problem.code:
        case "several-roots":
            return problem.code, ()
        case "bad-element":
            return problem.code, (*problem.parts, problem.sentence)
        case _:
            return problem.code, problem.parts


def _problems_of(read: ReadRobot) -> tuple[Problem, ...]:
    """What the structure of a robot has wrong that is not the one that is shown."""
    order = tuple(part.key for part in read.parts)
    return Assembly(read.name).apply(order, read.parts).problems
