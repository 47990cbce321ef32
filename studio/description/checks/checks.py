"""All checks of a run and its texts, of a good run or of what can be read of broken texts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.description.checks.checked_run import CheckedRun
from studio.description.checks.names import odd_names, repeated_names, unused_names
from studio.description.checks.spelling import misspelt_names
from studio.description.checks.ties import Holding, loose_ties
from studio.description.evaluator.output_tree import part_of, plain_parts
from studio.description.values import Checked, ReadRobot

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.evaluator.runs import GoodRun, RecoveredRun
    from studio.problems import Place, Problem


def checked_good(run: GoodRun, chain_to: Callable[[str], tuple[Place, ...]]) -> Checked:
    """Return the findings of a run; none if stock xacro made it, for it knows no places."""
    if run.evaluator != "studio":
        return Checked(())
    record = run.record
    return Checked(check_texts(CheckedRun(run.root, record.trees, record.bindings, chain_to)))


def checked_broken(run: RecoveredRun) -> Checked:
    """Return what is wrong with broken texts, and the findings in what can be read of them.

    Raises:
        Refusal: The robot has more text than can be shown.
    """
    if run.root is None:
        return Checked(run.problems)
    evaluation, trees = run.evaluation, run.store.trees(run.store.asked)
    bindings = tuple(evaluation.bindings.values())
    found = check_texts(CheckedRun(run.root, trees, bindings, evaluation.chain_to))
    parts = tuple(part_of(one) for one in plain_parts(run.root))
    return Checked((*run.problems, *found), ReadRobot(run.root.attributes.get("name", ""), parts))


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
