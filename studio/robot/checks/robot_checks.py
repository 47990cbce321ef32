"""All checks of a robot, each finding as a Problem at its place in the texts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.problems import Problem, modules_of
from studio.robot import checks
from studio.robot.checks.mending import Mender

if TYPE_CHECKING:
    from studio.robot.checks.finding import CheckedRobot, Finding

Check: TypeAlias = Callable[["CheckedRobot"], Iterator["Finding"]]
ALIKE_AT_MOST: Final = 200
"""Findings of one code that are listed one by one: nobody reads ten thousand."""


def check_robot(checked: CheckedRobot) -> tuple[Problem, ...]:
    """Return everything that is wrong with a robot, with a fix where one is safe.

    The tree of links and joints is not checked here: `structure` does that.
    """
    mender = Mender(checked.source)
    found: list[Problem] = []
    counts = Counter[str]()
    left_out: dict[str, Finding] = {}
    for one in robot_findings(checked):
        counts[one.code] += 1
        if counts[one.code] <= ALIKE_AT_MOST:
            found.append(_problem(one, checked, mender))
        else:
            left_out[one.code] = one
    return (*found, *(_more(one, counts[one.code]) for one in left_out.values()))


def _more(last: Finding, count: int) -> Problem:
    more = count - ALIKE_AT_MOST
    sentence = (
        f'{more:,} more parts have the fault "{last.code}": mend those that are listed first.'
    )
    return Problem(last.severity, last.code, sentence)


def robot_findings(checked: CheckedRobot) -> Iterator[Finding]:
    """Yield the findings of every check, before their places and fixes are found."""
    for check in _checks():
        yield from check(checked)


@cache
def _checks() -> tuple[Check, ...]:
    """Return the function `findings` of every file in this folder that has one."""
    modules = modules_of(checks)
    return tuple(module.findings for module in modules if hasattr(module, "findings"))


def _problem(finding: Finding, checked: CheckedRobot, mender: Mender) -> Problem:
    part = checked.part(finding.key) if finding.key else None
    return Problem(
        finding.severity,
        finding.code,
        finding.sentence,
        part.place if part else None,
        macro_stack=part.calls if part else (),
        fix=mender.fix(finding.mend, part) if finding.mend and part else None,
        parts=tuple(key for key in (finding.key, *finding.others) if key),
    )
