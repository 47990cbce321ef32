from __future__ import annotations

from studio.ros.action.protocol import ANY_GOAL, CancelCode, GoalStatus, KnownGoal, goals_to_cancel
from studio.ros.types.library import TypeLibrary


def goal(number: int, status: GoalStatus = GoalStatus.EXECUTING) -> KnownGoal:
    return KnownGoal(bytes([number] * 16), number * 10, status)


GOALS = [goal(1), goal(2), goal(3, GoalStatus.SUCCEEDED), goal(4, GoalStatus.ACCEPTED)]


def numbers(goal_id: bytes, stamp_ns: int) -> list[int]:
    return [one.goal_id[0] for one in goals_to_cancel(GOALS, goal_id, stamp_ns)[0]]


def test_an_id_means_that_goal_alone():
    assert numbers(goal(2).goal_id, 0) == [2]


def test_neither_id_nor_stamp_means_every_goal_under_way():
    assert numbers(ANY_GOAL, 0) == [1, 2, 4]


def test_a_stamp_means_those_accepted_until_then():
    assert numbers(ANY_GOAL, 20) == [1, 2]


def test_an_id_with_a_stamp_means_both():
    assert numbers(goal(4).goal_id, 10) == [1, 4]


def test_an_unknown_goal_and_one_that_is_over_are_told_apart():
    assert goals_to_cancel(GOALS, bytes([9] * 16), 0) == ([], CancelCode.ERROR_UNKNOWN_GOAL_ID)
    assert goals_to_cancel(GOALS, goal(3).goal_id, 0) == ([], CancelCode.ERROR_GOAL_TERMINATED)
    canceling = goal(5, GoalStatus.CANCELING)
    assert goals_to_cancel([canceling], canceling.goal_id, 0) == (
        [],
        CancelCode.ERROR_GOAL_TERMINATED,
    )


def test_numbers_are_those_of_action_msgs():
    constants = TypeLibrary("jazzy").service("action_msgs/srv/CancelGoal").Response
    assert all(getattr(constants, code.name) == code for code in CancelCode)
