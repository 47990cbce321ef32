"""What a panel is told of how topics come."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.rates import topic_rates
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.topic_rates import GetTopicRates, TopicRate
from studio.ros.messages import message
from studio.settings import WireChoice
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Awaitable, Callable

    from studio.ros.client import Node

pytestmark = pytest.mark.network
STRING = message("std_msgs/msg/String")


@asynccontextmanager
async def wire_at(endpoint: str) -> AsyncGenerator[RosConnection]:
    connection = RosConnection(WireChoice("off", (endpoint,)))
    try:
        yield connection
    finally:
        await connection.close()


async def until_true(holds: Callable[[], Awaitable[bool]]) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while not await holds():  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.02)


async def rate_of(wire: RosConnection, topic: str) -> TopicRate | None:
    found = await topic_rates(wire.topics, GetTopicRates(request=7, topics=(topic,)))
    assert found.request == 7
    return found.rates[0] if found.rates else None


def test_without_a_connection_nothing_is_known_and_none_is_made(endpoint: str):
    async def story() -> None:
        async with wire_at(endpoint) as wire:
            assert await rate_of(wire, "/chatter") is None
            assert wire.current is None

    asyncio.run(story())


def test_a_topic_waits_then_lives_then_is_silent(endpoint: str, tester: Node):
    out = tester.create_publisher(STRING, "/chatter", 10)

    async def story() -> None:
        async with wire_at(endpoint) as wire:
            await wire.link()

            async def reaches(state: str, *, talks: bool) -> bool:
                if talks:
                    out.publish(STRING(data="x"))
                rate = await rate_of(wire, "/chatter")
                return rate is not None and rate.state == state

            await until_true(lambda: reaches("waiting", talks=False))
            await until_true(lambda: reaches("live", talks=True))
            await until_true(lambda: reaches("silent", talks=False))

    asyncio.run(story())


def test_a_latched_topic_that_spoke_before_is_not_called_silent(endpoint: str, tester: Node):
    out = tester.create_publisher(STRING, "/description", LATCHED)
    out.publish(STRING(data="<robot/>"))

    async def story() -> None:
        async with wire_at(endpoint) as wire:
            await wire.link()

            async def is_latched() -> bool:
                rate = await rate_of(wire, "/description")
                assert rate is None or rate.state != "silent"
                return rate is not None and rate.state == "latched"

            await until_true(is_latched)

    asyncio.run(story())
