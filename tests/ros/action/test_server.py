from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    GoalStatus,
)
from studio.ros.action.protocol import CancelCode
from studio.ros.node.context import Context
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.qos import qos_profile_action_status_default
from tests.support.goals import FIBONACCI, Held, action_pair, finished
from tests.support.wire import PATIENCE_S, open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from studio.ros.action import ServerGoalHandle
    from studio.ros.types.library import ActionType

pytestmark = pytest.mark.network


def accept_cancel(goal: ServerGoalHandle) -> CancelResponse:
    del goal
    return CancelResponse.ACCEPT


def kind_of(goal: ServerGoalHandle) -> ActionType:
    server = goal._server  # pyright: ignore[reportPrivateUsage]
    assert isinstance(server, ActionServer)
    return server.action_type


def count_up(goal: ServerGoalHandle) -> object:
    kind = kind_of(goal)
    for number in range(goal.request.order):
        goal.publish_feedback(kind.Feedback(sequence=[number]))
    goal.succeed()
    return kind.Result(sequence=range(goal.request.order))


def test_a_goal_gives_feedback_status_and_a_result():
    with action_pair(count_up) as pair:
        goal = pair.send(3)
        assert goal.accepted
        answer = finished(goal.get_result_async())
        assert (answer.status, list(answer.result.sequence)) == (GoalStatus.SUCCEEDED, [0, 1, 2])
        wait_until("all feedback", lambda: len(pair.heard) == 3)
        assert [list(told.feedback.sequence) for told in pair.heard] == [[0], [1], [2]]
        assert goal.status is GoalStatus.SUCCEEDED


def test_a_coroutine_works_on_a_goal_too():
    async def execute(goal: ServerGoalHandle) -> object:
        return count_up(goal)

    with action_pair(execute) as pair:
        assert finished(pair.send().get_result_async()).status == GoalStatus.SUCCEEDED


def test_a_goal_may_be_refused():
    def decide(request: Any) -> GoalResponse:  # noqa: ANN401
        return GoalResponse.ACCEPT if request.order < 10 else GoalResponse.REJECT

    with action_pair(count_up, goal_callback=decide) as pair:
        assert not pair.send(10).accepted
        assert pair.send(9).accepted


def test_a_callback_that_raises_refuses_the_goal_and_the_server_goes_on(
    capsys: pytest.CaptureFixture[str],
):
    def decide(request: Any) -> GoalResponse:  # noqa: ANN401
        if request.order == 1:
            raise ValueError("no such order")
        return GoalResponse.ACCEPT

    with action_pair(count_up, goal_callback=decide) as pair:
        assert not pair.send(1).accepted
        assert pair.send(2).accepted
    assert "Error raised in decide of the action" in capsys.readouterr().err


def test_work_that_raises_aborts_its_goal_and_the_server_goes_on(
    capsys: pytest.CaptureFixture[str],
):
    def execute(goal: ServerGoalHandle) -> object:
        if goal.request.order == 1:
            raise ValueError("cannot count so far")
        return count_up(goal)

    with action_pair(execute) as pair:
        assert finished(pair.send(1).get_result_async()).status == GoalStatus.ABORTED
        assert finished(pair.send(2).get_result_async()).status == GoalStatus.SUCCEEDED
    assert "ValueError: cannot count so far" in capsys.readouterr().err


def test_a_goal_whose_state_nobody_set_is_aborted(capsys: pytest.CaptureFixture[str]):
    def execute(goal: ServerGoalHandle) -> object:
        return kind_of(goal).Result(sequence=[7])

    with action_pair(execute) as pair:
        answer = finished(pair.send().get_result_async())
        assert (answer.status, list(answer.result.sequence)) == (GoalStatus.ABORTED, [7])
    assert "Goal state not set, assuming aborted" in capsys.readouterr().err


@pytest.mark.parametrize("returned", [None, "a text", "feedback"])
def test_work_that_returns_no_result_gives_an_empty_one(returned: str | None):
    def execute(goal: ServerGoalHandle) -> object:
        goal.succeed()
        return kind_of(goal).Feedback() if returned == "feedback" else returned

    with action_pair(execute) as pair:
        answer = finished(pair.send().get_result_async())
        assert (answer.status, list(answer.result.sequence)) == (GoalStatus.SUCCEEDED, [])


def test_a_goal_ends_when_it_is_asked_to():
    held = Held()
    with action_pair(held, cancel_callback=accept_cancel) as pair:
        goal = pair.send()
        wait_until("it is under way", lambda: len(held.goals) == 1)
        answer = finished(goal.cancel_goal_async())
        assert answer.return_code == CancelCode.ERROR_NONE
        assert [info.goal_id for info in answer.goals_canceling] == [goal.goal_id]
        assert held.goals[0].is_cancel_requested
        held.end("canceled")
        assert finished(goal.get_result_async()).status == GoalStatus.CANCELED


def test_a_server_lets_no_goal_end_unless_it_is_told_to():
    held = Held()
    with action_pair(held) as pair:
        goal = pair.send()
        answer = finished(goal.cancel_goal_async())
        assert (answer.return_code, answer.goals_canceling) == (CancelCode.ERROR_REJECTED, [])
        held.end("succeed")
        assert finished(goal.get_result_async()).status == GoalStatus.SUCCEEDED
        answer = finished(goal.cancel_goal_async())
        assert answer.return_code == CancelCode.ERROR_GOAL_TERMINATED


def test_several_goals_are_under_way_at_once_and_end_in_any_order():
    held = Held()
    with action_pair(held) as pair:
        goals = [pair.send() for _ in range(5)]
        asked = [goal.get_result_async() for goal in goals]
        for place in (3, 0, 4, 1):
            held.end("succeed" if place % 2 else "abort", place)
        wait_until("four ended", lambda: sum(one.done() for one in asked) == 4)
        assert not asked[2].done()
        held.end("succeed", 2)
        statuses = [finished(one).status for one in asked]
        assert statuses == [
            GoalStatus.SUCCEEDED if n in (1, 2, 3) else GoalStatus.ABORTED for n in range(5)
        ]


def test_goals_may_wait_until_they_are_begun():
    waiting: list[ServerGoalHandle] = []
    with action_pair(count_up, handle_accepted_callback=waiting.append) as pair:
        goal = pair.send()
        wait_until("it was handed over", lambda: bool(waiting))
        assert waiting[0].status is GoalStatus.ACCEPTED
        waiting[0].execute()
        assert finished(goal.get_result_async()).status == GoalStatus.SUCCEEDED


def test_a_goal_that_is_begun_while_nobody_spins_is_worked_on_when_somebody_does():
    waiting: list[ServerGoalHandle] = []
    with action_pair(count_up, handle_accepted_callback=waiting.append) as pair:
        goal = pair.send()
        wait_until("it was handed over", lambda: bool(waiting))
        executor = pair.serving.executor
        assert executor is not None
        executor.remove_node(pair.serving)
        waiting[0].execute()
        assert waiting[0].status is GoalStatus.EXECUTING
        executor.add_node(pair.serving)
        assert finished(goal.get_result_async()).status == GoalStatus.SUCCEEDED


def test_work_whose_awaited_future_is_cancelled_aborts_its_goal_and_the_server_goes_on(
    capsys: pytest.CaptureFixture[str],
):
    async def execute(goal: ServerGoalHandle) -> object:
        if goal.request.order == 1:
            given_up = goal.result.__class__()
            given_up.cancel()
            await given_up
        return count_up(goal)

    with action_pair(execute) as pair:
        assert finished(pair.send(1).get_result_async()).status == GoalStatus.ABORTED
        assert finished(pair.send(2).get_result_async()).status == GoalStatus.SUCCEEDED
    assert "CancelledError" in capsys.readouterr().err


def test_a_late_comer_hears_the_status_of_goals_that_were_before():
    with action_pair(count_up) as pair:
        finished(pair.send().get_result_async())
        kind = pair.asking.wire.types.message("action_msgs/msg/GoalStatusArray")
        heard: list[Any] = []
        pair.asking.create_subscription(
            kind, "/fibonacci/_action/status", heard.append, qos_profile_action_status_default
        )

        def told() -> list[int]:
            return [one.status for one in heard[-1].status_list] if heard else []

        wait_until("the last status", lambda: told() == [GoalStatus.SUCCEEDED])


def test_an_id_that_is_known_already_is_refused_without_asking_about_its_goal():
    held = Held()
    asked: list[int] = []

    def decide(request: Any) -> GoalResponse:  # noqa: ANN401
        asked.append(request.order)
        return GoalResponse.ACCEPT

    with action_pair(held, goal_callback=decide) as pair:
        first = pair.send()
        again = pair.client.send_goal_async(
            pair.client.action_type.Goal(order=1), goal_uuid=first.goal_id
        )
        assert not finished(again).accepted
        assert len(asked) == 1
        held.end("succeed")
        assert finished(first.get_result_async()).status == GoalStatus.SUCCEEDED


def test_a_result_that_is_no_longer_kept_is_of_an_unknown_goal():
    with action_pair(count_up, result_timeout=0.0) as pair:
        goal = pair.send()
        wait_until("it ended", lambda: goal.status.is_over)
        # Its time begins when its work has returned, a moment after its end was told.
        wait_until(
            "it is unknown",
            lambda: finished(goal.get_result_async()).status == GoalStatus.UNKNOWN,
        )


def test_the_graph_knows_the_action_and_its_parts():
    with action_pair(count_up) as pair:
        assert ("/fibonacci", [FIBONACCI]) in pair.asking.graph.actions()
        feedback = pair.asking.graph.publishers("/fibonacci/_action/feedback")
        assert [one.type_name for one in feedback] == [f"{FIBONACCI}_FeedbackMessage"]


def test_a_server_that_is_destroyed_is_there_no_more():
    with action_pair(count_up) as pair:
        before = len(pair.serving._ends) - 1  # pyright: ignore[reportPrivateUsage]
        pair.server.destroy()
        assert len(pair.serving._ends) == before  # pyright: ignore[reportPrivateUsage]
        wait_until("it is gone", lambda: not pair.client.server_is_ready())


def test_an_action_works_between_nodes_of_humble():
    with running_router() as endpoint, open_test_session(endpoint, distro="humble") as wire:
        context = Context.over(wire)
        executor = SingleThreadedExecutor(context=context)
        server, client = (Node(name, context=context) for name in ("server", "client"))
        executor.add_node(server)
        executor.add_node(client)
        kind = wire.types.action(FIBONACCI)
        ActionServer(server, kind, "fibonacci", lambda goal: goal.succeed())
        asking = ActionClient(client, kind, "fibonacci")
        assert asking.wait_for_server(PATIENCE_S)
        sent = asking.send_goal_async(kind.Goal())
        executor.spin_until_future_complete(sent, PATIENCE_S)
        asked = sent.result().get_result_async()
        executor.spin_until_future_complete(asked, PATIENCE_S)
        assert asked.result().status == GoalStatus.SUCCEEDED
        hashes = {one.type_hash for one in client.graph.endpoints_of(client.graph.nodes()[0])}
        assert hashes == {"TypeHashNotSupported"}
        context.shutdown()
