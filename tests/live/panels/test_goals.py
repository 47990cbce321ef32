from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import StudioError
from studio.live.panels.goals import Goal
from studio.protocol.goals import CancelGoal, GetGoalStatuses, SendGoal
from studio.ros.action import ActionClient, ActionServer, GoalResponse
from studio.ros.messages import shared_types
from tests.support.bridged import Bridged, bridged
from tests.support.goals import FIBONACCI, Held
from tests.support.open_documents import until
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Node

pytestmark = pytest.mark.network
UNWANTED = 13


@pytest.fixture
def held(tester: Node) -> Generator[Held]:
    """A server whose goals end when the test says so and not before; one order is refused."""

    def take(goal: Any) -> GoalResponse:  # noqa: ANN401 - of the action's own class
        return GoalResponse.REJECT if goal.order == UNWANTED else GoalResponse.ACCEPT

    work = Held()
    kind = tester.wire.types.action(FIBONACCI)
    server = ActionServer(tester, kind, "fibonacci", work, goal_callback=take)
    yield work
    for place, future in enumerate(work.futures):
        if not future.done():
            work.end("abort", place)
    server.destroy()


async def begun(page: Bridged, order: int = 3) -> int:
    ask = SendGoal(name="fibonacci", action_type=FIBONACCI, text=f"{{order: {order}}}")
    return await page.begin(ask)


def test_a_server_that_lets_no_goal_end_is_told_of_and_the_goal_goes_on(endpoint: str, held: Held):
    async def run() -> None:
        async with bridged(endpoint) as page:
            number = await begun(page)
            await page.operation_in("goals", number, "executing")
            with pytest.raises(StudioError, match="goes on: its server does not let it end"):
                await page.do(CancelGoal(operation=number))
            assert page.ros.goals.operations.get(number).state == "executing"
            await asyncio.to_thread(held.end, "succeed")
            await page.operation_in("goals", number, "succeeded")
            await page.do(CancelGoal(operation=number))  # what is over stays as it is
            assert page.ros.goals.operations.get(number).state == "succeeded"

    asyncio.run(run())


def test_a_goal_is_refused_and_another_is_aborted(endpoint: str, held: Held):
    async def run() -> None:
        async with bridged(endpoint) as page:
            refused, aborted = await begun(page, UNWANTED), await begun(page)
            assert (await page.operation_in("goals", refused, "rejected"))["result"] == ""
            await page.operation_in("goals", aborted, "executing")
            await asyncio.to_thread(held.end, "abort")
            told = await page.operation_in("goals", aborted, "aborted")
            assert told["result"] == '{"sequence":[]}'

    asyncio.run(run())


def test_beside_an_aborted_goal_stands_what_its_server_logged_last_as_a_warning(
    endpoint: str, tester: Node, held: Held
):
    async def run() -> None:
        async with bridged(endpoint) as page:
            log = tester.get_logger()
            log.warning("said of an earlier goal")
            first = await begun(page)
            await page.operation_in("goals", first, "executing")
            log.warning("the way is blocked")
            log.get_child("arm").error("the arm is stuck")
            log.info("giving up")
            await asyncio.to_thread(held.end, "abort")
            await until(lambda: page.operation("goals", first).get("server_said") is not None)
            told = page.operation("goals", first)
            assert told["servers"] == [tester.get_fully_qualified_name()]
            assert told["server_said"]["text"] == "the arm is stuck"
            second = await begun(page)
            await page.operation_in("goals", second, "executing")
            await asyncio.to_thread(held.end, "abort", 1)
            await page.operation_in("goals", second, "aborted")
            await page.ros.let_go_of_operations()  # waits until all that ends has ended
            assert page.operation("goals", second)["server_said"] is None

    asyncio.run(run())


def test_goals_of_others_are_told_apart_from_ours(endpoint: str, tester: Node, held: Held):
    async def run() -> None:
        async with bridged(endpoint) as page:
            number = await begun(page)
            told = await page.operation_in("goals", number, "executing")
            client = ActionClient(tester, tester.wire.types.action(FIBONACCI), "fibonacci")
            client.send_goal_async(client.action_type.Goal(order=5))
            await asyncio.to_thread(wait_until, "two goals", lambda: len(held.goals) == 2)
            ours: dict[str, bool] = {}
            while len(ours) < 2:
                answer = await page.do(GetGoalStatuses(name="/fibonacci"))
                ours = {one.goal_id: one.is_ours for one in answer.goals}
                await asyncio.sleep(0.01)
            assert ours.pop(told["goal_id"]) is True
            assert list(ours.values()) == [False]
            client.destroy()

    asyncio.run(run())


@pytest.mark.usefixtures("held")
def test_with_the_connection_goals_are_lost_and_it_is_said_that_they_may_go_on(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            number = await begun(page)
            await page.operation_in("goals", number, "executing")
            await page.ros.let_go()
            await until(lambda: page.operation("goals", number)["state"] == "failed")
            assert "may go on" in page.operation("goals", number)["trouble"]

    asyncio.run(run())


def test_an_action_that_nobody_serves_is_said_to_be_so(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            ask = SendGoal(name="/nobody", action_type=FIBONACCI, timeout_s=0.2)
            told = await page.operation_in("goals", await page.begin(ask), "failed")
            assert told["trouble"].startswith("No node serves the action /nobody")

    asyncio.run(run())


@pytest.mark.parametrize("text", ["{orders: 1}", "{order: many}", "[1]"])
def test_what_is_no_goal_is_refused(endpoint: str, text: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            with pytest.raises(StudioError, match="Fibonacci_Goal"):
                await page.do(SendGoal(name="/x", action_type=FIBONACCI, text=text))

    asyncio.run(run())


def test_feedback_without_end_is_kept_to_a_number_and_told_once_each():
    feedback = shared_types().action(FIBONACCI).Feedback
    goal = Goal(1, "/x", FIBONACCI, "")
    for number in range(500):
        goal.take_feedback(feedback(sequence=[number]))
    first = goal.view(is_whole=False)
    assert (first.feedback_count, len(first.feedback)) == (500, 50)
    assert first.feedback[-1].values == '{"sequence":[499]}'
    goal.take_feedback(feedback(sequence=[1]))
    assert [one.number for one in goal.view(is_whole=False).feedback] == [501]
    assert len(goal.view(is_whole=True).feedback) == 50
