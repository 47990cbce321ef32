"""Answers what is wrong with the texts, from the last good run or from what can be read of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.checks.check_values import Checked, ReadRobot
from studio.description.checks.checked_run import CheckedRun
from studio.description.checks.text_checks import check_texts
from studio.description.evaluator.parts import part_of, write_parts

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.evaluator.recovering import RecoveredRun
    from studio.description.origins.good_run import GoodRun
    from studio.problems import Place


def checked_good(run: GoodRun, chain_to: Callable[[str], tuple[Place, ...]]) -> Checked:
    """The findings of a run; of one that stock xacro made none, for it tells no places."""
    if run.evaluator != "studio":
        return Checked(())
    record = run.record
    return Checked(check_texts(CheckedRun(run.root, record.trees, record.bindings, chain_to)))


def checked_broken(run: RecoveredRun) -> Checked:
    """What is wrong with broken texts, and the findings in what can be read of them.

    Raises:
        Refusal: The robot comes to more text than can be shown.
    """
    if run.root is None:
        return Checked(run.problems)
    evaluation, trees = run.evaluation, run.store.trees(run.store.asked)
    bindings = tuple(evaluation.bindings.values())
    found = check_texts(CheckedRun(run.root, trees, bindings, evaluation.chain_to))
    parts = tuple(part_of(one) for one in write_parts(run.root))
    return Checked((*run.problems, *found), ReadRobot(run.root.attributes.get("name", ""), parts))
