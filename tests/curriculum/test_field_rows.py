"""The course's rows J1 and SV4, as the panels that draw Jerry and turtlesim do them."""

from __future__ import annotations

import asyncio
import json
import math
from typing import TYPE_CHECKING, Any

import pytest

from studio.protocol.calls import CallService
from studio.protocol.publishing import Publish
from studio.protocol.topics import ListTopics
from tests.support.bridged import Bridged, bridged
from tests.support.demos import heard, node_at, running_demo
from tests.support.open_documents import until

if TYPE_CHECKING:
    from studio.ros.client import Node

pytestmark = [pytest.mark.network, pytest.mark.timeout(120)]
COMMAND = "pkg_with_interfaces/msg/JerryCommand"
DISTANCE = "pkg_with_interfaces/srv/Distance"
SPAWN = "turtlesim/srv/Spawn"
POSE = "turtlesim/msg/Pose"


async def called(page: Bridged, called_name: str, kind: str, **values: float | str) -> Any:  # noqa: ANN401
    """Call a service as a panel does; its reply."""
    text = json.dumps(values)
    number = await page.begin(
        CallService(name=called_name, service_type=kind, text=text, timeout_s=60)
    )
    told = await page.operation_in("calls", number, "answered", "failed")
    assert told["state"] == "answered", told["trouble"]
    return json.loads(told["reply"])


async def stands_at(places: list[Any], x_m: float, y_m: float) -> None:
    await until(lambda: bool(places) and (places[-1].x, places[-1].y) == (x_m, y_m))


def test_j1_jerrys_position_follows_commands_and_his_distances_are_exact(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "jerry_robot"):
        asyncio.run(_command_and_measure(endpoint, node))


async def _command_and_measure(endpoint: str, node: Node) -> None:
    places = heard(node, "geometry_msgs/msg/Point", "/jerry/pose")
    await until(lambda: bool(node.graph.servers("/distance")))
    async with bridged(endpoint) as page:

        async def go(direction: str, steps: int) -> None:
            text = json.dumps({"direction": direction, "steps": steps})
            await page.begin(Publish(name="/jerry_command", message_type=COMMAND, text=text))

        for direction, steps, place in (
            ("forward", 3, (3.0, 0.0)),
            ("left", 5, (3.0, 5.0)),
            ("backward", 7, (-4.0, 5.0)),
            ("right", 1, (-4.0, 4.0)),
        ):
            await go(direction, steps)
            await stands_at(places, *place)
        await go("up", 2)
        await go("forward", 1)
        await stands_at(places, -3.0, 4.0)
        for x, y in ((0.0, 0.0), (1.25, -7.5), (-3.0, 4.0)):
            answer = await called(page, "/distance", DISTANCE, x=x, y=y)
            assert answer["distance"] == math.hypot(x + 3.0, y - 4.0)


def test_sv4_a_second_turtle_that_a_page_asks_for_is_listed_and_tells_where_it_is(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "turtlesim_node"):
        asyncio.run(_spawn(endpoint, node))


async def _spawn(endpoint: str, node: Node) -> None:
    poses = heard(node, POSE, "/turtle2/pose")
    await until(lambda: bool(node.graph.servers("/spawn")))
    async with bridged(endpoint) as page:
        reply = await called(page, "/spawn", SPAWN, x=2.0, y=3.0, theta=0.2, name="")
        assert reply == {"name": "turtle2"}
        await until(lambda: bool(poses))
        assert (poses[-1].x, poses[-1].y) == (2.0, 3.0)
        table = await page.do(ListTopics())
        row = next(one for one in table.topics if one.name == "/turtle2/pose")
        assert (row.types, row.publishers) == ((POSE,), 1)
