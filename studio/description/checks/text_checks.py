"""All checks of a run and its texts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.checks.names import odd_names
from studio.description.checks.spelling import misspelt_names
from studio.description.checks.ties import loose_ties
from studio.description.checks.unused import unused_names

if TYPE_CHECKING:
    from studio.description.checks.checked_run import CheckedRun
    from studio.problems import Problem


def check_texts(run: CheckedRun) -> tuple[Problem, ...]:
    """Everything that the checks find, what keeps the robot from being whole first."""
    return (*loose_ties(run), *odd_names(run), *misspelt_names(run), *unused_names(run))
