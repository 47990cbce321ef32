from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, cast

from studio.ros.action.server_goal import GOALS_KEPT_MAX, ServerGoals

if TYPE_CHECKING:
    from studio.ros.action.server_goal import ServerGoalHandle


class Clock:
    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


def goal_of(number: int) -> tuple[bytes, ServerGoalHandle]:
    """The little of a goal that its keeper looks at."""
    goal_id = number.to_bytes(16, "big")
    goal = SimpleNamespace(goal_id=SimpleNamespace(uuid=goal_id), ended_s=None)
    return goal_id, cast("ServerGoalHandle", goal)


def test_an_id_is_taken_once():
    goals = ServerGoals(10.0)
    goal_id, goal = goal_of(1)
    assert goals.add(goal_id, lambda: goal) is goal
    assert goals.add(goal_id, lambda: goal_of(1)[1]) is None
    assert goals.find(goal_id) is goal


def test_a_goal_that_is_over_is_kept_for_its_time():
    clock = Clock()
    goals = ServerGoals(10.0, clock)
    (over_id, over), (other_id, other) = goal_of(1), goal_of(2)
    goals.add(over_id, lambda: over)
    goals.add(other_id, lambda: other)
    goals.end(over)
    clock.now_s = 9.9
    assert goals.all() == [over, other]
    clock.now_s = 10.0
    assert goals.all() == [other]
    clock.now_s = 1e9
    assert goals.find(other_id) is other


def test_of_those_that_are_over_the_last_are_kept():
    clock = Clock()
    goals = ServerGoals(1e9, clock)
    for number in range(GOALS_KEPT_MAX + 5):
        goal_id, goal = goal_of(number)
        goals.add(goal_id, lambda goal=goal: goal)
        clock.now_s += 1
        goals.end(goal)
    assert len(goals.all()) == GOALS_KEPT_MAX
    assert goals.find(goal_of(0)[0]) is None
    assert goals.find(goal_of(GOALS_KEPT_MAX + 4)[0]) is not None


def test_a_goal_may_be_forgotten_before_its_time():
    goals = ServerGoals(10.0)
    goal_id, goal = goal_of(1)
    goals.add(goal_id, lambda: goal)
    goals.remove(goal)
    goals.remove(goal)
    assert goals.all() == []
