"""Pages are told that the graph or the log changed, and ask for it then."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING

import pytest

from studio.live.panels.changes import Changes
from studio.protocol.changes import FollowChanges
from studio.protocol.logs import GetLog
from studio.ros.messages import message
from tests.support.bridged import bridged
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from studio.ros.client import Node


def told(ear: Ear, subject: str) -> int:
    """How often a page was told of changes."""
    return sum(one["type"] == "changed" and one["subject"] == subject for one in ear.events)


def test_who_follows_is_told_from_any_thread_and_nobody_else():
    async def run() -> None:
        changes, follower, other = Changes(), Ear(), Ear()
        changes.follow(FollowChanges(subject="log"), follower)
        changes.follow(FollowChanges(subject="graph"), other)
        for _ in range(50):
            thread = threading.Thread(target=changes.changed_elsewhere, args=("log",))
            thread.start()
            thread.join()
        await until(lambda: told(follower, "log") > 0)
        assert told(follower, "log") == 1  # however much changed
        assert not other.events
        changes.follow(FollowChanges(subject="log", following=False), follower)
        changes.detach(other)
        changes.changed("graph")
        changes.changed_elsewhere("log")
        await changes.close()
        assert not other.events

    asyncio.run(run())


@pytest.mark.network
def test_a_line_of_the_log_and_a_new_topic_are_told(endpoint: str, tester: Node):
    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(FollowChanges(subject="log"))
            await page.do(FollowChanges(subject="graph"))
            await page.do(GetLog())
            graph = told(page.ear, "graph")
            tester.create_publisher(message("std_msgs/msg/String"), "/new", 10)
            await until(lambda: told(page.ear, "graph") > graph)

            def is_told() -> bool:
                tester.get_logger().info("a line")
                return told(page.ear, "log") > 0

            await until(is_told)

    asyncio.run(run())
