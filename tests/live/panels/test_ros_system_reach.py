"""Nodes that cannot be reached: the router is away, or who was asked has ended."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import RouterGoneError
from studio.live.panels.ros_system import COMMANDS
from studio.protocol.calls import CallService
from studio.protocol.goals import CancelGoal, SendGoal
from studio.protocol.publishing import Drive, Publish, StopPublishing
from studio.ros.action import ActionServer
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from tests.support.bridged import Bridged, bridged
from tests.support.demos import heard, node_at
from tests.support.goals import FIBONACCI, Held
from tests.support.open_documents import until
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.client import Node

pytestmark = [pytest.mark.network, pytest.mark.timeout(180)]
ADD, STRING = "example_interfaces/srv/AddTwoInts", "std_msgs/msg/String"
GONE = "The router at {} is gone"


def serve_nothing(node: Node) -> Callable[[], bool]:
    """A service that takes a request and never answers; gives whether it has taken one."""
    taken: list[object] = []

    async def never(request: Any, response: Any) -> Any:  # noqa: ANN401
        taken.append(request)
        await Future[Any](executor=None)
        return response

    kind, own_group = node.wire.types.service(ADD), ReentrantCallbackGroup()
    node.create_service(kind, "/silent", never, callback_group=own_group)
    return lambda: bool(taken)


def serve_goals(node: Node) -> Held:
    work = Held()
    ActionServer(node, node.wire.types.action(FIBONACCI), "fibonacci", work)
    return work


ASK = CallService(name="/silent", service_type=ADD, text="{}", timeout_s=600)
GOAL = SendGoal(name="fibonacci", action_type=FIBONACCI, text="{order: 3}")
SAY = Publish(name="/said", message_type=STRING, text="{data: again}", rate_hz=50)


async def fails(page: Bridged, kind: str, number: int) -> str:
    return (await page.operation_in(kind, number, "failed"))["trouble"]


async def refused_without_router(page: Bridged, goal: int, endpoint: str) -> None:
    """Nothing is begun that nobody can hear of, and nothing waits for its time-out."""
    for command in (ASK, GOAL, SAY, CancelGoal(operation=goal)):
        with pytest.raises(RouterGoneError, match=GONE.format(endpoint)):
            await page.do(command)


def test_with_the_router_a_call_ends_and_a_goal_and_a_publication_go_on_when_it_is_back():
    endpoint = free_endpoint()

    async def run(node: Node) -> None:
        is_asked, work = serve_nothing(node), serve_goals(node)
        said = heard(node, STRING, "/said")
        async with bridged(endpoint) as page:
            call, goal, saying = [await page.begin(one) for one in (ASK, GOAL, SAY)]
            await page.operation_in("goals", goal, "executing")
            await until(lambda: is_asked() and bool(said))
            await asyncio.to_thread(router.close)
            assert GONE.format(endpoint) in await fails(page, "calls", call)
            await refused_without_router(page, goal, endpoint)
            before = len(said)
            with router_at(endpoint):
                await until(lambda: len(said) > before)
                await asyncio.to_thread(work.end, "succeed")
                await page.operation_in("goals", goal, "succeeded")
                await page.do(StopPublishing(operation=saying))

    with router_at(endpoint) as router, node_at(endpoint) as node:
        asyncio.run(run(node))


async def drive_on(page: Bridged) -> None:
    """Hold the stick until it is refused."""
    while True:
        await page.do(Drive(topic="/cmd_vel", stamped=False, x=1.0, y=0.0, yaw=0.0))
        await asyncio.sleep(0.02)


def test_a_robot_that_was_driven_when_the_router_went_stands_still_once_it_is_back():
    endpoint = free_endpoint()

    async def run(node: Node) -> None:
        told = heard(node, "geometry_msgs/msg/Twist", "/cmd_vel")
        async with bridged(endpoint) as page:
            driving = asyncio.create_task(drive_on(page))
            await until(lambda: bool(told))
            await asyncio.to_thread(router.close)
            with pytest.raises(RouterGoneError):
                await driving
            assert told[-1].linear.x == 1.0
            page.ros.detach(page.ear)  # else it ends in half a second, with the router back
            with router_at(endpoint):
                await until(lambda: told[-1].linear.x == 0.0)

    with router_at(endpoint) as router, node_at(endpoint) as node:
        asyncio.run(run(node))


def test_a_server_that_ends_amid_a_call_is_said_to_have_ended(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            with node_at(endpoint, "doomed") as doomed:
                is_asked = serve_nothing(doomed)
                call = await page.begin(ASK)
                await until(is_asked)
            assert "ended before it answered" in await fails(page, "calls", call)

    asyncio.run(run())


def test_a_server_that_ends_amid_a_goal_is_said_to_have_ended(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            with node_at(endpoint, "doomed") as doomed:
                serve_goals(doomed)
                goal = await page.begin(GOAL)
                await page.operation_in("goals", goal, "executing")
            assert "ended before the goal did" in await fails(page, "goals", goal)

    asyncio.run(run())


def test_what_nobody_could_hear_of_is_all_that_needs_the_router():
    asking = {"call_service", "send_goal", "cancel_goal", "get_parameters", "dump_parameters"}
    doing = {"set_parameter", "load_parameters", "change_state", "publish", "drive"}
    assert {one.permission.name for one in COMMANDS if one.needs_router} == asking | doing
