"""Pages are told that something changed, and ask for it then."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING

import pytest

from studio.live.panels.changes import Changes
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.changes import FollowChanges
from studio.protocol.diagnostics import GetDiagnostics
from studio.protocol.goals import GetGoalStatuses
from studio.protocol.logs import GetLog
from studio.ros.messages import message
from tests.support.bridged import bridged
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from studio.ros.client import Node, Publisher


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


def test_of_another_connection_all_is_told_anew():
    async def run() -> None:
        changes, follower = Changes(), Ear()
        for subject in ("graph", "diagnostics", "lessons"):
            changes.follow(FollowChanges(subject=subject), follower)
        changes.all_changed()
        for subject in ("graph", "diagnostics", "lessons"):
            await until(lambda subject=subject: told(follower, subject) == 1)
        assert told(follower, "log") == 0
        await changes.close()

    asyncio.run(run())


@pytest.mark.network
def test_how_parts_are_and_states_of_goals_are_told(endpoint: str, tester: Node):
    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.do(FollowChanges(subject="diagnostics"))
            await page.do(FollowChanges(subject="goal_statuses"))
            await page.do(GetDiagnostics())
            await page.do(GetGoalStatuses(name="/dock"))
            parts = message("diagnostic_msgs/msg/DiagnosticArray")
            goals = message("action_msgs/msg/GoalStatusArray")
            outs = {
                "diagnostics": tester.create_publisher(parts, "/diagnostics", 10),
                "goal_statuses": tester.create_publisher(goals, "/dock/_action/status", LATCHED),
            }
            kinds = {"diagnostics": parts, "goal_statuses": goals}
            for subject, out in outs.items():

                def is_told(subject: str = subject, out: Publisher = out) -> bool:
                    out.publish(kinds[subject]())
                    return told(page.ear, subject) > 0

                await until(is_told)

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
