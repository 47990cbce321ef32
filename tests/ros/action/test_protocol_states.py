from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import GoalStateError
from studio.ros.action.protocol import GoalEvent, GoalStatus, can_follow, next_status
from studio.ros.types.library import TypeLibrary

FLOW = [
    ("ACCEPTED", "EXECUTE", "EXECUTING"),
    ("ACCEPTED", "CANCEL_GOAL", "CANCELING"),
    ("EXECUTING", "CANCEL_GOAL", "CANCELING"),
    ("EXECUTING", "SUCCEED", "SUCCEEDED"),
    ("EXECUTING", "ABORT", "ABORTED"),
    ("CANCELING", "SUCCEED", "SUCCEEDED"),
    ("CANCELING", "ABORT", "ABORTED"),
    ("CANCELING", "CANCELED", "CANCELED"),
]


@pytest.mark.parametrize(("before", "event", "after"), FLOW)
def test_a_goal_goes_its_way(before: str, event: str, after: str):
    assert next_status(GoalStatus[before], GoalEvent[event]) is GoalStatus[after]


def test_nothing_else_happens_to_a_goal():
    allowed = {(before, event) for before, event, _ in FLOW}
    for status, event in product(GoalStatus, GoalEvent):
        if (status.name, event.name) not in allowed:
            assert not can_follow(status, event)
            with pytest.raises(GoalStateError):
                next_status(status, event)


@given(st.lists(st.sampled_from(GoalEvent)))
def test_a_goal_that_is_over_stays_over(events: list[GoalEvent]):
    status = GoalStatus.ACCEPTED
    for event in events:
        was_over = status.is_over
        if can_follow(status, event):
            assert not was_over
            status = next_status(status, event)
    assert status.is_over != status.is_active


def test_numbers_are_those_of_action_msgs():
    constants = TypeLibrary("jazzy").message("action_msgs/msg/GoalStatus")
    for status in GoalStatus:
        assert getattr(constants, f"STATUS_{status.name}") == status


def test_an_error_says_what_cannot_be():
    with pytest.raises(GoalStateError, match="A goal that is succeeded cannot be aborted"):
        next_status(GoalStatus.SUCCEEDED, GoalEvent.ABORT)


@pytest.mark.parametrize("number", [-1, 7, 127])
def test_a_number_that_is_no_status_says_nothing(number: int):
    assert GoalStatus(number) is GoalStatus.UNKNOWN
