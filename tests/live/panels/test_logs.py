"""What nodes say on /rosout, heard while there is a connection."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.logs import NodeLogs
from studio.protocol.logs import GetLog
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.settings import WireChoice
from tests.support.memory_source import MemorySource
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from studio.protocol.logs import LogAnswer
    from studio.ros.client import Node

pytestmark = pytest.mark.network


async def until_said(logs: NodeLogs, text: str) -> LogAnswer:
    async with asyncio.timeout(PATIENCE_S):
        while True:
            answer = logs.log(GetLog())
            if any(one.text == text for one in answer.lines):
                return answer
            await asyncio.sleep(0.02)


LOG = "rcl_interfaces/msg/Log"


def line(node: str, level: int, text: str) -> bytes:
    said = message(LOG)(name=node, level=level, msg=text)
    said.stamp.sec = 100
    return bytes(codec_of(message(LOG)).encode(said))


def test_a_warning_of_a_node_is_waited_for():
    async def run() -> None:
        source = MemorySource()
        out = source.offer("/rosout", LOG)
        logs = NodeLogs(source)
        begin = logs.listen()
        waiting = asyncio.create_task(
            logs.newest_warning(["/dock"], after=begin, since_s=50.0, patience_s=PATIENCE_S)
        )
        await asyncio.sleep(0)
        out.say(line("dock", 20, "as usual"))
        await asyncio.sleep(0)
        out.say(line("other", 40, "not this one"))
        out.say(line("dock", 30, "this one"))
        found = await waiting
        assert found is not None
        assert found.text == "this one"
        later = logs.newest_warning(["/dock"], after=found.number, since_s=50.0, patience_s=0.01)
        assert await later is None

    asyncio.run(run())


def test_it_is_heard_from_the_first_question_on_with_what_was_said_before(
    endpoint: str, tester: Node
):
    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        logs = NodeLogs(wire.topics)
        try:
            before = logs.log(GetLog(request=3))
            assert (before.request, before.connected, before.lines) == (3, False, ())
            tester.get_logger().warning("said before")
            await wire.link()
            answer = await until_said(logs, "said before")
            (line,) = (one for one in answer.lines if one.text == "said before")
            assert (line.node, line.level) == (tester.get_name(), 30)
            tester.get_logger().error("said after")
            newer = await until_said(logs, "said after")
            assert newer.last > answer.last
            await wire.disconnect()
            kept = logs.log(GetLog(after=line.number))
            assert not kept.connected
            assert "said after" in [one.text for one in kept.lines]
            await wire.link()
            tester.get_logger().info("heard again")
            await until_said(logs, "heard again")
        finally:
            await wire.close()

    asyncio.run(run())
