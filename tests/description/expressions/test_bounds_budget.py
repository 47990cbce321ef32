"""The budget of a run: no real file comes near it, and each bound is told by its own sentence."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.expressions.bounds import Budget, Limits
from studio.description.faults import Fault, Refusal
from tests.support.descriptions import evaluation_of, policy_for

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

ROOM = 10
"""The largest real robot needs at most this part of each bound."""


@pytest.mark.corpus
def test_no_real_file_needs_more_than_a_tenth_of_any_bound(corpus: Path):
    policy = policy_for(corpus)
    limits = Limits()
    tenth = Limits(
        macro_depth=limits.macro_depth // ROOM,
        elements=limits.elements // ROOM,
        evaluations=limits.evaluations // ROOM,
        text=limits.text // ROOM,
    )
    refused: list[str] = []
    for file in sorted(corpus.rglob("*.xacro")):
        try:
            evaluation_of(policy, limits=tenth).run(str(file))
        except Refusal as refusal:
            refused.append(f"{file}: {refusal.code}")
        except Fault:
            continue
    assert [one for one in refused if "outside-roots" not in one] == []


BOUNDS: dict[str, tuple[Limits, Callable[[Budget], None]]] = {
    "too-many-elements": (Limits(elements=3), lambda budget: budget.element()),
    "too-many-evaluations": (Limits(evaluations=3), lambda budget: budget.evaluation()),
    "too-much-text": (Limits(text=3), lambda budget: budget.text(1)),
    "expansion-too-slow": (Limits(seconds=0), lambda budget: budget.evaluation()),
}


def exhaust(budget: Budget, spend: Callable[[Budget], None]) -> None:
    for _ in range(100):
        spend(budget)


@pytest.mark.parametrize("code", BOUNDS)
def test_a_bound_is_kept_and_a_new_count_begins_anew(code: str):
    limits, spend = BOUNDS[code]
    budget = Budget(limits)
    with pytest.raises(Refusal) as refused:
        exhaust(budget, spend)
    assert refused.value.code == code
    budget.restart()
    spend(budget)


def test_each_turn_of_a_loop_counts():
    budget = Budget(Limits(evaluations=50))
    with pytest.raises(Refusal):
        list(budget.steps(range(1_000)))


def test_calls_may_be_as_deep_as_the_bound():
    budget = Budget(Limits(macro_depth=5))
    budget.depth(5, "m")
    with pytest.raises(Refusal, match="calls itself"):
        budget.depth(6, "m")


def test_who_writes_at_length_may_have_all_of_it_made():
    budget = Budget(Limits(elements=3, seconds=1))
    budget.source("/a.urdf", 1_600)
    budget.source("/a.urdf", 1_600)  # included twice, read once
    assert budget.elements == 103
    assert budget.seconds == 1
    with pytest.raises(Refusal, match="more than 103 elements"):
        exhaust_elements(budget, 104)


def test_no_file_is_so_long_that_its_run_may_last_for_minutes():
    budget = Budget(Limits(seconds=2))
    budget.source("/a.urdf", (1 << 20) + 150_000)
    assert budget.seconds == 3
    budget.source("/a.urdf", 1 << 40)
    assert budget.seconds == 32


def exhaust_elements(budget: Budget, count: int) -> None:
    for _ in range(count):
        budget.element()
