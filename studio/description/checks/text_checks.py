"""All checks of a run and its texts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.description.checks.duplicates import repeated_names
from studio.description.checks.holding import Holding
from studio.description.checks.names import odd_names
from studio.description.checks.spelling import misspelt_names
from studio.description.checks.ties import loose_ties
from studio.description.checks.unused import unused_names

if TYPE_CHECKING:
    from studio.description.checks.checked_run import CheckedRun
    from studio.problems import Problem


def check_texts(run: CheckedRun) -> tuple[Problem, ...]:
    """Everything that the checks find, what keeps the robot from being whole first."""
    held = tuple(Holding(run).problems())
    ties = (*held, *(_unless_mended(one, held) for one in loose_ties(run)))
    names = (*repeated_names(run), *odd_names(run), *misspelt_names(run))
    return (*ties, *names, *unused_names(run))


def _unless_mended(problem: Problem, held: tuple[Problem, ...]) -> Problem:
    """Roots are not tied once more where a joint's own mend ties them: both would be too much."""
    if problem.code == "several-roots" and any(one.fix for one in held):
        return replace(problem, fix=None)
    return problem
