from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import ActionServerGoneError, DroppedError, MessageValueError, NotServedError
from studio.ros.action import ActionClient, GoalStatus
from studio.ros.messages import shared_types
from tests.support.demos import node_at, running_demo
from tests.support.goals import FIBONACCI, Held, action_pair, finished
from tests.support.patience import Stopwatch
from tests.support.wire import PATIENCE_S, running_router, wait_until

if TYPE_CHECKING:
    from studio.ros.action import ServerGoalHandle

pytestmark = pytest.mark.network


def test_a_goal_of_another_action_is_refused_before_it_is_sent():
    with action_pair(Held()) as pair:
        turn = pair.asking.wire.types.action("turtlesim/action/RotateAbsolute")
        with pytest.raises(MessageValueError, match="Fibonacci_Goal"):
            pair.client.send_goal_async(turn.Goal())


def test_whoever_waits_for_a_server_waits_no_longer_than_told():
    with running_router() as endpoint, node_at(endpoint, "client") as node:
        client = ActionClient(node, node.wire.types.action(FIBONACCI), "fibonacci")
        watch = Stopwatch()
        assert not client.wait_for_server(timeout_sec=0.2)
        assert watch.s < 5.0
        sent = client.send_goal_async(client.action_type.Goal())
        with pytest.raises(NotServedError, match="the action /fibonacci"):
            finished(sent)


def test_a_server_that_ends_in_the_middle_ends_the_wait_for_its_result():
    held = Held()
    with action_pair(held) as pair:
        goal = pair.send()
        asked = goal.get_result_async()
        wait_until("it is under way", lambda: len(held.goals) == 1)
        pair.serving.destroy_node()
        with pytest.raises(ActionServerGoneError, match="/fibonacci ended before the goal did"):
            finished(asked)
        with pytest.raises(ActionServerGoneError):
            finished(goal.cancel_goal_async())


def test_a_node_that_is_killed_in_the_middle_of_an_action_ends_the_wait_with_a_sentence():
    slow = ("--ros-args", "-p", "step_seconds:=30.0")
    with (
        running_router() as endpoint,
        node_at(endpoint) as node,
        running_demo(endpoint, "radio_dj", *slow) as server,
    ):
        kind = node.wire.types.action("radio_station_interfaces/action/ChooseSong")
        client = ActionClient(node, kind, "choose_song")
        assert client.wait_for_server(PATIENCE_S)
        asked = finished(client.send_goal_async(kind.Goal(song_name="Clocks"))).get_result_async()
        watch = Stopwatch()
        server.process.kill()
        with pytest.raises(ActionServerGoneError, match="/choose_song ended before the goal did"):
            finished(asked)
        assert watch.s < 5.0


def test_a_client_that_is_destroyed_lets_nobody_wait():
    held = Held()
    with action_pair(held) as pair:
        asked = pair.send().get_result_async()
        pair.client.destroy()
        wait_until("it is told", asked.done)


def test_who_gives_a_result_up_may_ask_again():
    held = Held()
    with action_pair(held) as pair:
        goal = pair.send()
        asked = goal.get_result_async()
        asked.cancel()
        assert asked.cancelled()
        held.end("succeed")
        assert finished(goal.get_result_async()).status == GoalStatus.SUCCEEDED


def test_a_goal_is_sent_and_awaited_in_one_call_beside_a_node_that_spins():
    with action_pair(lambda goal: goal.succeed()) as pair:
        answer = pair.client.send_goal(pair.client.action_type.Goal(order=1))
        assert answer.status == GoalStatus.SUCCEEDED


def test_feedback_of_others_goals_is_not_heard():
    held = Held()
    with action_pair(held) as pair:
        mine, other = pair.send(), pair.client.action_type.Goal()
        finished(pair.client.send_goal_async(other))
        wait_until("both are under way", lambda: len(held.goals) == 2)
        for goal in reversed(held.goals):
            goal.publish_feedback(pair.kind.Feedback(sequence=[1]))
        wait_until("mine is heard", lambda: bool(pair.heard))
        assert [told.goal_id for told in pair.heard] == [mine.goal_id]


def test_goals_are_awaited_in_asyncio_too():
    async def ask(client: ActionClient) -> object:
        goal = await client.send_goal_async(client.action_type.Goal(order=1))
        return (await goal.get_result_async()).status

    with action_pair(lambda goal: goal.succeed()) as pair:
        assert asyncio.run(ask(pair.client)) == GoalStatus.SUCCEEDED


def test_a_flood_of_goals_is_answered_or_said_to_be_dropped():
    with action_pair(lambda goal: goal.succeed()) as pair:
        kind = pair.client.action_type
        sent = [pair.client.send_goal_async(kind.Goal(order=order)) for order in range(200)]
        wait_until("all are settled", lambda: all(one.done() for one in sent))
        errors = {type(error) for one in sent if (error := one.exception()) is not None}
        assert errors <= {DroppedError}
        assert sum(one.exception() is None for one in sent) >= 10
        assert pair.send().accepted


def test_goals_that_are_sent_together_keep_their_own_results():
    def execute(goal: ServerGoalHandle) -> object:
        goal.succeed()
        return shared_types().action(FIBONACCI).Result(sequence=[goal.request.order])

    with action_pair(execute) as pair:
        kind = pair.client.action_type
        sent = [pair.client.send_goal_async(kind.Goal(order=order)) for order in range(9)]
        asked = [finished(one).get_result_async() for one in sent]
        assert [list(finished(one).result.sequence) for one in asked] == [[n] for n in range(9)]


def test_a_status_that_comes_before_the_acceptance_is_not_lost():
    held = Held()
    with action_pair(held) as pair:
        goal = pair.send()
        wait_until("it was told", lambda: goal.status is GoalStatus.EXECUTING)
        answered = pair.client._answered  # pyright: ignore[reportPrivateUsage]
        reply = pair.client.action_type.SendGoal.Response(accepted=True)
        assert answered(goal.goal_id, reply).status is GoalStatus.EXECUTING
