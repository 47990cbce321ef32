"""A topic that is heard while there is a connection, and again with the next one."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.desk import WireDesk
from studio.live.panels.heard_topic import HeardTopic
from studio.settings import WireChoice

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.link import WireLink

pytestmark = pytest.mark.network


def test_it_is_heard_once_for_each_connection_and_let_go_of_before_its_end(endpoint: str):
    begun: list[WireLink] = []
    ended: list[WireLink] = []

    def hear(link: WireLink) -> Callable[[], None]:
        begun.append(link)
        return lambda: ended.append(link)

    async def run() -> None:
        wire = WireDesk(WireChoice("off", (endpoint,)))
        topic = HeardTopic(wire, hear)
        try:
            await topic.listen()
            assert not topic.is_heard
            first = await wire.link()
            await asyncio.gather(topic.listen(), topic.listen())
            assert topic.is_heard
            assert begun == [first]
            await topic.let_go()
            assert ended == [first]
            await wire.disconnect()
            second = await wire.link()
            await topic.listen()
            assert begun == [first, second]
            await topic.let_go()
            await topic.let_go()
            assert ended == [first, second]
        finally:
            await wire.close()

    asyncio.run(run())
