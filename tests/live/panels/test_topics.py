from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import RosNameError
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.topics import topic_ends, topic_table
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.topics import GetTopicEnds, ListTopics, TopicEnds, TopicRow
from studio.ros.messages import message
from studio.ros.qos import qos_profile_sensor_data
from studio.settings import WireChoice
from tests.support.open_documents import until

if TYPE_CHECKING:
    from studio.ros.client import Node

pytestmark = pytest.mark.network

SCAN, IMU = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu"


def test_topics_are_told_with_their_ends_and_what_would_keep_those_apart(
    endpoint: str, tester: Node
):
    tester.create_publisher(message(SCAN), "/scan", qos_profile_sensor_data)
    tester.create_subscription(message(SCAN), "/scan", print, LATCHED)
    tester.create_subscription(message(IMU), "/scan", print, 10)

    async def run() -> tuple[TopicRow, TopicEnds]:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        assert (await topic_table(wire, ListTopics())).topics == ()
        try:
            link = await wire.link()
            await until(lambda: len(link.graph.subscriptions("/scan")) == 2)
            table = await topic_table(wire, ListTopics(request=3))
            return next(one for one in table.topics if one.name == "/scan"), topic_ends(
                wire, GetTopicEnds(topic="/scan")
            )
        finally:
            await wire.close()

    row, ends = asyncio.run(run())
    assert (row.types, row.publishers, row.subscribers) == ((SCAN, IMU), 1, 2)
    assert row.kind == "LaserScan"
    (publisher,) = ends.publishers
    assert (publisher.node, publisher.own, publisher.depth) == ("/tester", False, 5)
    assert (publisher.reliability, publisher.durability) == ("best effort", "volatile")
    assert publisher.deadline_s is None
    by_heard = {one.heard: one.reasons for one in ends.misfits}
    assert by_heard[True] == (
        "the publisher is best effort, the subscription wants reliable",
        "the publisher is volatile, the subscription wants transient local",
    )
    assert by_heard[False][0] == f"one sends {SCAN}, the other wants {IMU}"


def test_what_is_no_topic_has_no_ends(endpoint: str):
    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        try:
            await wire.link()
            with pytest.raises(RosNameError):
                topic_ends(wire, GetTopicEnds(topic="no topic"))
        finally:
            await wire.close()

    asyncio.run(run())


def test_what_the_studio_publishes_counts_and_by_what_it_listens_does_not(endpoint: str):
    async def run() -> dict[str, tuple[int, int]]:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        try:
            link = await wire.link()
            link.node.create_publisher(message(SCAN), "/told", 10)
            link.node.create_subscription(message(SCAN), "/heard", print, 10)
            await until(lambda: bool(link.graph.subscriptions("/heard")))
            await until(lambda: bool(link.graph.publishers("/told")))
            table = await topic_table(wire, ListTopics())
            return {one.name: (one.publishers, one.subscribers) for one in table.topics}
        finally:
            await wire.close()

    counts = asyncio.run(run())
    assert counts["/told"] == (1, 0)
    assert "/heard" not in counts
