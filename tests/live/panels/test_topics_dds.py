"""The ends of topics on DDS: behind which bridge they are, and what keeps them apart there."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.topics import topic_ends
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.topics import GetTopicEnds
from studio.ros.messages import message
from studio.ros.qos import qos_profile_sensor_data
from studio.settings import WireChoice
from tests.support.dds_bridge import DdsNetwork
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.live.connection.link import WireLink
    from studio.protocol.topics import TopicEnds
    from studio.ros.client import Node

pytestmark = pytest.mark.network

STRING = "std_msgs/msg/String"
BEST_EFFORT = {"reliability": "best_effort"}
WANTS_EARLIER = {"durability": "transient_local", "depth": 1}


@pytest.fixture(scope="module")
def network() -> Generator[DdsNetwork]:
    with DdsNetwork() as made:
        yield made


def ends_of(endpoint: str, topic: str, holds: Callable[[WireLink], bool]) -> TopicEnds:
    """The ends, once something holds of the connection."""

    async def run() -> TopicEnds:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        try:
            link = await wire.link()
            await until(lambda: holds(link))
            return topic_ends(wire, GetTopicEnds(topic=topic))
        finally:
            await wire.close()

    return asyncio.run(run())


def test_two_ends_on_dds_whose_qos_does_not_match_are_said_not_to_hear_each_other(
    network: DdsNetwork, endpoint: str
):
    bridge, robot = network.bridge(connect=endpoint, namespace="/one"), network.robot()
    robot.ask("publish", topic="/apart", type_name=STRING, qos=BEST_EFFORT, rate_hz=20.0)
    robot.ask("node", node="/ear")
    robot.ask("subscribe", topic="/apart", type_name=STRING, node="/ear")
    told = ends_of(
        endpoint,
        "/one/apart",
        lambda link: bool(
            link.graph.publishers("/one/apart") and link.graph.subscriptions("/one/apart")
        ),
    )
    ((publisher,), (subscriber,)) = told.publishers, told.subscribers
    assert (publisher.node, publisher.bridge, publisher.own) == ("/one/robot", "/one", False)
    assert (subscriber.node, subscriber.bridge) == ("/one/ear", "/one")
    (misfit,) = told.misfits
    assert (misfit.way, misfit.heard) == ("dds", False)
    assert misfit.reasons == ("the publisher is best effort, the subscription wants reliable",)
    assert not robot.all_said("heard", topic="/apart"), "DDS itself says the same"
    for one in (robot, bridge):
        one.end()


def test_between_dds_and_zenoh_a_bridge_makes_up_for_all_but_earlier_messages(
    network: DdsNetwork, endpoint: str, tester: Node
):
    bridge, robot = network.bridge(connect=endpoint), network.robot()
    robot.ask("publish", topic="/note", type_name=STRING, qos=BEST_EFFORT)
    robot.ask("subscribe", topic="/order", type_name=STRING, qos=WANTS_EARLIER)
    tester.create_subscription(message(STRING), "/note", print, LATCHED)
    tester.create_publisher(message(STRING), "/order", qos_profile_sensor_data)
    told = ends_of(
        endpoint,
        "/note",
        lambda link: bool(link.graph.publishers("/note") and link.graph.subscriptions("/note")),
    )
    late = ("the publisher is volatile, the subscription wants transient local",)
    assert [(one.way, one.heard, one.reasons) for one in told.misfits] == [("bridge", True, late)]
    other = ends_of(
        endpoint,
        "/order",
        lambda link: bool(link.graph.publishers("/order") and link.graph.subscriptions("/order")),
    )
    assert [one.bridge for one in other.publishers] == [""]
    assert [(one.way, one.heard, one.reasons) for one in other.misfits] == [("bridge", True, late)]
    for one in (robot, bridge):
        one.end()


def test_an_end_of_humble_on_dds_tells_no_hash_and_is_compared_by_name(
    network: DdsNetwork, endpoint: str, tester: Node
):
    bridge = network.bridge(connect=endpoint, domain=0, distro="humble")
    robot = network.robot(distro="humble")
    robot.ask("publish", topic="/old", type_name=STRING)
    tester.create_subscription(message(STRING), "/old", print, 10)
    told = ends_of(
        endpoint,
        "/old",
        lambda link: bool(link.graph.publishers("/old") and link.graph.subscriptions("/old")),
    )
    assert [one.hash for one in told.publishers] == [""]
    assert told.misfits == ()
    for one in (robot, bridge):
        one.end()
