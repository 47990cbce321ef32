"""Checks the texts of a document and the structure of its robot, with fixes."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.debounce import Debouncer
from studio.description.values import Checked, CheckQuery, ReadRobot
from studio.errors import CommandError
from studio.problems import Fix, Problem
from studio.protocol.roles import Role
from studio.robot.assembly import Assembly

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable, Sequence

    from studio.description.values import Expansion, Failure, Part
    from studio.documents.checks.pace import Pace
    from studio.documents.findings import Findings
    from studio.documents.model import Model
    from studio.documents.runs import Runs
    from studio.documents.urdf import UrdfText
    from studio.documents.workspace import Workspace
    from studio.robot.worker_client import UrdfValidator


_VALIDATE_AFTER_S: Final = 0.3
"""Quiet time after a structural change before yourdfpy is asked for its opinion."""
_XML: Final = "xml-"
"""Prefix of the codes of broken texts, which a run reports itself."""

_log = logging.getLogger(__name__)


class TextChecks:
    """Reports the problems of runs at once, and those of the texts' checks after a pause.

    It asks the worker as a viewer does, so that editors are answered first.

    Args:
        workspace: The texts.
        runs: Asks the worker, and knows whether the last run failed.
        findings: Takes the problems.
        validate: Returns what another reader of URDF finds in the present robot.
        pace: When the checks start.
    """

    role = Role.GUEST
    person = ""

    def __init__(
        self,
        workspace: Workspace,
        runs: Runs,
        findings: Findings,
        validate: Callable[[], Awaitable[tuple[Problem, ...]]],
        pace: Pace,
    ) -> None:
        self._workspace, self._runs, self._findings = workspace, runs, findings
        self._validate = validate
        self._of_robot: tuple[Problem, ...] = ()
        self._of_texts: tuple[Problem, ...] = ()
        self._second_opinion: tuple[Problem, ...] = ()
        self._checking = Debouncer(self._check, pace.quiet_s, pace.opened)
        validate_after_s = min(_VALIDATE_AFTER_S, pace.quiet_s)
        self._validating = Debouncer(self._take_opinion, validate_after_s, pace.opened)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Send nothing: replies are returned to the caller."""

    def sees(self, document: str) -> bool:
        """It asks of its own document alone."""
        del document
        return True

    def failed(self, failure: Failure) -> None:
        """A run gave no robot."""
        first, *others = failure.problems or (failure.problem,)
        self._findings.replace("expansion", (self._with_undo(first), *others))
        self._checking.trigger()

    def expanded(
        self, expansion: Expansion, of_robot: tuple[Problem, ...], *, structural: bool
    ) -> None:
        """A run gave a robot, with these problems."""
        self._findings.replace("expansion", expansion.warnings)
        self._of_robot = of_robot
        self._report()
        if structural:
            self._validating.trigger()
        self._checking.trigger()

    @property
    def is_settled(self) -> bool:
        """Whether the texts as they are now were checked, by yourdfpy too."""
        return self._checking.is_settled and self._validating.is_settled

    async def settled(self) -> None:
        """Wait until the texts as they are now were checked, by yourdfpy too."""
        await asyncio.gather(self._checking.settled(), self._validating.settled())

    async def close(self) -> None:
        """Check no more."""
        self._checking.cancel()
        self._validating.cancel()
        await asyncio.gather(self._checking.close(), self._validating.close())

    async def _check(self) -> None:
        try:
            await self._take(await self._runs.answer(CheckQuery(), Checked, self))
        except CommandError:
            return  # what was found last stands until there is a robot again
        except Exception:  # noqa: BLE001 - the checks of one text may not end those of the next
            _log.exception("The checks of %s failed.", self._workspace.path)

    async def _take(self, checked: Checked) -> None:
        of_robot = checked.read and await asyncio.to_thread(_problems_of, checked.read)
        self._of_texts = tuple(one for one in checked.problems if not one.code.startswith(_XML))
        if of_robot is not None and self._runs.last.failed:
            self._of_robot = of_robot
        self._report()

    async def _take_opinion(self) -> None:
        self._second_opinion = await self._validate()
        self._report()

    def _report(self) -> None:
        found = merged(self._of_robot, self._of_texts)
        self._findings.replace("robot", found)
        codes = {one.code for one in found}
        more = [one for one in self._second_opinion if one.code not in codes]
        self._findings.replace("validation", more if codes.isdisjoint(_EXPLAIN) else ())

    def _with_undo(self, problem: Problem) -> Problem:
        """Offer to give what is missing, or to take the edit back that may have broken it."""
        has_robot = self._runs.last.expansion is not None
        if problem.fix:
            return problem
        if problem.code == "undefined-argument" and not has_robot:
            return replace(problem, fix=Fix("Give it a value", "give_arguments"))
        if not self._workspace.sources.undo_labels or not has_robot:
            return problem
        return replace(problem, fix=Fix("Undo edit", "undo"))


_EXPLAIN: Final = frozenset(
    {
        *("bad-element", "cycle", "dangling-child", "dangling-parent", "duplicate-joint"),
        *("duplicate-link", "no-links", "second-parent", "several-roots"),
    }
)
"""Codes of faults that yourdfpy fails at as well, so that its message does not help."""
_OF_BOTH: Final = frozenset(
    {
        *("bad-element", "dangling-parent", "dangling-child", "duplicate-joint", "duplicate-link"),
        *("second-parent", "several-roots"),
    }
)
"""Codes found in the robot's structure and in the texts; the texts know the place and a fix."""


def merged(of_robot: Iterable[Problem], of_texts: Sequence[Problem]) -> tuple[Problem, ...]:
    """Return each fact once: as found in the robot, with place and fix from the texts.

    A fact about the structure counts only while it is found in the robot, too.
    """
    better = {_fact(one): one for one in of_texts if one.code in _OF_BOTH}
    found = [replace(better.get(_fact(one), one), severity=one.severity) for one in of_robot]
    return (*found, *(one for one in of_texts if one.code not in _OF_BOTH))


async def second_opinion(
    model: Model, urdf: UrdfText, validator: UrdfValidator
) -> tuple[Problem, ...]:
    """Return what yourdfpy finds in the present URDF.

    Raises:
        CommandError: There is no URDF yet.
    """
    found = await validator.validate(await urdf.text())
    return tuple(placed(one, model.assembly.part) for one in found)


def placed(problem: Problem, part: Callable[[str], Part | None]) -> Problem:
    """Return a problem of a part of the robot, at the place where that is written."""
    found = part(problem.parts[0]) if problem.parts else None
    return replace(problem, place=found.place, macro_stack=found.calls) if found else problem


def _fact(problem: Problem) -> tuple[str, tuple[str, ...]]:
    """Return what a finding is about; all roots are one fact, each element is its own."""
    match problem.code:
        case "several-roots":
            return problem.code, ()
        case "bad-element":
            return problem.code, (*problem.parts, problem.sentence)
        case _:
            return problem.code, problem.parts


def _problems_of(read: ReadRobot) -> tuple[Problem, ...]:
    """Return the problems in the structure of a robot that is not the one shown."""
    order = tuple(part.key for part in read.parts)
    return Assembly(read.name).apply(order, read.parts).problems
