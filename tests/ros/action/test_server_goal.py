from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import GoalStateError, MessageValueError
from studio.ros.action import GoalStatus
from tests.support.goals import ActionPair, Held, action_pair
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.action import ServerGoalHandle

pytestmark = pytest.mark.network


@pytest.fixture
def pair() -> Generator[tuple[ActionPair, ServerGoalHandle]]:
    """A goal under way, and both ends."""
    held = Held()
    with action_pair(held) as made:
        made.send(5)
        wait_until("it is under way", lambda: len(held.goals) == 1)
        yield made, held.goals[0]


def test_a_goal_is_known_by_its_request_id_and_state(pair: tuple[ActionPair, ServerGoalHandle]):
    goal = pair[1]
    assert goal.request.order == 5
    assert goal.info.goal_id == goal.goal_id
    assert goal.info.stamp.sec > 0
    assert (goal.status, goal.is_active) == (GoalStatus.EXECUTING, True)
    assert not goal.is_cancel_requested


def test_a_goal_is_begun_and_ended_once(pair: tuple[ActionPair, ServerGoalHandle]):
    goal = pair[1]
    with pytest.raises(GoalStateError, match="executing cannot be executed"):
        goal.execute()
    with pytest.raises(GoalStateError, match="executing cannot end canceled"):
        goal.canceled()
    goal.succeed()
    assert not goal.is_active
    with pytest.raises(GoalStateError, match="succeeded cannot be aborted"):
        goal.abort()


def test_feedback_of_another_type_is_refused(pair: tuple[ActionPair, ServerGoalHandle]):
    made, goal = pair
    with pytest.raises(MessageValueError, match="Fibonacci_Feedback"):
        goal.publish_feedback(made.kind.Result())


def test_a_goal_that_is_forgotten_is_in_no_status(pair: tuple[ActionPair, ServerGoalHandle]):
    made, goal = pair
    goal.destroy()
    again = made.client.send_goal_async(made.kind.Goal(), goal_uuid=goal.goal_id)
    wait_until("its id is free", again.done)
    assert again.result().accepted
