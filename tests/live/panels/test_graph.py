"""Who is there and who speaks with whom, as panels are told (rows N1, N2 and N4)."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.graph import GraphViews
from studio.protocol.graph import GetGraph, GetNode, GraphAnswer, GraphLinkView
from studio.ros.action.client import ActionClient
from studio.ros.action.server import ActionServer
from studio.ros.messages import action, message, service
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable

pytestmark = pytest.mark.network
STRING = message("std_msgs/msg/String")
TRIGGER = service("std_srvs/srv/Trigger")
ROTATE = action("turtlesim/action/RotateAbsolute")


def ignore(*_: Any) -> None:  # noqa: ANN401
    """Take what comes."""


@asynccontextmanager
async def views_at(endpoint: str) -> AsyncGenerator[GraphViews]:
    wire = RosConnection(WireChoice("off", (endpoint,)))
    try:
        await wire.link()
        yield GraphViews(wire)
    finally:
        await wire.close()


async def told(views: GraphViews, holds: Callable[[GraphAnswer], bool]) -> GraphAnswer:
    """The first answer of which it holds."""
    async with asyncio.timeout(PATIENCE_S):
        while not holds(answer := await views.graph(GetGraph())):  # noqa: ASYNC110 - nothing tells us
            await asyncio.sleep(0.02)
    return answer


def link(answer: GraphAnswer, name: str) -> GraphLinkView | None:
    return next((one for one in answer.links if one.name == name), None)


def ends(answer: GraphAnswer, found: GraphLinkView) -> tuple[list[str], list[str]]:
    names = [one.name for one in answer.nodes]
    return [names[at] for at in found.sources], [names[at] for at in found.targets]


def has_both_ends(answer: GraphAnswer, *names: str) -> bool:
    found = [link(answer, name) for name in names]
    return all(one and one.sources and one.targets for one in found)


def test_without_a_connection_nobody_is_there():
    async def run() -> None:
        views = GraphViews(RosConnection(WireChoice("off")))
        answer = await views.graph(GetGraph(known=3))
        assert (answer.version, answer.nodes) == (-1, ())
        assert (await views.node(GetNode(name="/talker"))).count == 0

    asyncio.run(run())


def test_n4_talker_and_listener_are_two_nodes_and_one_edge(endpoint: str):
    async def run() -> None:
        with node_at(endpoint, "talker") as talker, node_at(endpoint, "listener") as listener:
            talker.create_publisher(STRING, "/chatter", 10)
            listener.create_subscription(STRING, "/chatter", ignore, 10)
            async with views_at(endpoint) as views:
                answer = await told(views, lambda one: has_both_ends(one, "/chatter"))
                assert [one.name for one in answer.nodes if not one.own] == ["/listener", "/talker"]
                chatter = link(answer, "/chatter")
                assert chatter is not None
                assert (chatter.kind, chatter.types) == ("topic", ("std_msgs/msg/String",))
                assert ends(answer, chatter) == (["/talker"], ["/listener"])
                assert "/studio" in [one.name for one in answer.nodes if one.own]

    asyncio.run(run())


def test_nodes_of_others_are_counted_as_the_connection_counts_them(endpoint: str):
    async def run() -> None:
        # One has the name of the studio's own node, which makes them one box.
        with node_at(endpoint, "studio") as same, node_at(endpoint, "talker") as talker:
            same.create_subscription(STRING, "/chatter", ignore, 10)
            talker.create_publisher(STRING, "/chatter", 10)
            async with views_at(endpoint) as views:
                answer = await told(views, lambda one: has_both_ends(one, "/chatter"))
                assert sum(one.count for one in answer.nodes if not one.own) == 3
                assert answer.other_count == 2

    asyncio.run(run())


def test_services_and_actions_join_who_calls_and_who_serves(endpoint: str):
    async def run() -> None:
        with node_at(endpoint, "server") as server, node_at(endpoint, "caller") as caller:
            server.create_service(TRIGGER, "/ring", lambda _, answer: answer)
            caller.create_client(TRIGGER, "/ring")
            serving = ActionServer(server, ROTATE, "/turn", ignore)
            sending = ActionClient(caller, ROTATE, "/turn")
            async with views_at(endpoint) as views:
                answer = await told(views, lambda one: has_both_ends(one, "/ring", "/turn"))
                ring, turn = link(answer, "/ring"), link(answer, "/turn")
                assert ring is not None
                assert turn is not None
                assert (ring.kind, turn.kind) == ("service", "action")
                assert ends(answer, ring) == ends(answer, turn) == (["/caller"], ["/server"])
                feedback = link(answer, "/turn/_action/feedback")
                assert feedback is not None
                assert feedback.hidden
            sending.destroy()
            serving.destroy()

    asyncio.run(run())


def test_what_is_known_is_not_told_again(endpoint: str):
    async def run() -> None:
        async with views_at(endpoint) as views:
            first = await told(views, lambda one: bool(one.nodes))
            again = await views.graph(GetGraph(known=first.version))
            assert (again.version, again.nodes) == (first.version, ())
            with node_at(endpoint, "new"):
                async with asyncio.timeout(PATIENCE_S):
                    while not again.nodes:
                        again = await views.graph(GetGraph(known=first.version))
                assert again.version > first.version

    asyncio.run(run())


def test_n1_two_nodes_of_one_name_are_counted(endpoint: str):
    async def run() -> None:
        with node_at(endpoint, "twin"), node_at(endpoint, "twin"):
            async with views_at(endpoint) as views:
                answer = await told(views, lambda one: any(node.count == 2 for node in one.nodes))
                assert [one.name for one in answer.nodes if one.count == 2] == ["/twin"]
                assert (await views.node(GetNode(name="/twin"))).count == 2

    asyncio.run(run())


def test_n2_what_a_node_has_is_grouped_as_ros2_node_info_does(endpoint: str):
    async def run() -> None:
        with node_at(endpoint, "worker") as worker:
            worker.create_publisher(STRING, "/out", 10)
            worker.create_subscription(STRING, "/in", ignore, 10)
            worker.create_service(TRIGGER, "/ring", lambda _, answer: answer)
            worker.create_client(TRIGGER, "/other")
            serving = ActionServer(worker, ROTATE, "/turn", ignore)
            async with views_at(endpoint) as views:
                await told(views, lambda one: link(one, "/turn") is not None)
                node = await views.node(GetNode(request=4, name="/worker"))
                assert (node.request, node.count) == (4, 1)
                assert ("/out", "std_msgs/msg/String") in [
                    (e.name, e.type) for e in node.publishers
                ]
                assert [one.name for one in node.subscribers] == ["/in"]
                assert "/ring" in [one.name for one in node.service_servers]
                assert [one.name for one in node.service_clients] == ["/other"]
                assert [(one.name, one.type) for one in node.action_servers] == [
                    ("/turn", "turtlesim/action/RotateAbsolute")
                ]
                assert (await views.node(GetNode(name="/nobody"))).count == 0
            serving.destroy()

    asyncio.run(run())
