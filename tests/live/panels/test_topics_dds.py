"""The ends of topics on DDS: behind which bridge they are, and what keeps them apart there."""

from __future__ import annotations

import asyncio
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.topics import topic_ends
from studio.nodes.robot_state_publisher import LATCHED
from studio.protocol.topics import GetTopicEnds
from studio.ros.messages import message
from studio.ros.profiles import NO_HASH
from studio.ros.qos import QoSProfile, qos_profile_sensor_data
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.zenoh import close, declare_token
from studio.settings import WireChoice
from tests.support.dds_bridge import DdsNetwork, session_at
from tests.support.open_documents import until
from tests.support.pretend_bridge import PretendBridge, talking_bridge

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


def are_met(link: WireLink, topic: str, node: Node) -> bool:
    """Whether both ends are there, and the bridge may have heard of those of a node."""
    graph = link.graph
    are_there = bool(graph.publishers(topic) and graph.subscriptions(topic))
    return are_there and node.wire.zid in graph.announcing


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
    told = ends_of(endpoint, "/note", lambda link: are_met(link, "/note", tester))
    late = ("the publisher is volatile, the subscription wants transient local",)
    assert [(one.way, one.heard, one.reasons) for one in told.misfits] == [("bridge", True, late)]
    other = ends_of(endpoint, "/order", lambda link: are_met(link, "/order", tester))
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
    told = ends_of(endpoint, "/old", lambda link: are_met(link, "/old", tester))
    assert [one.hash for one in told.publishers] == [""]
    assert told.misfits == ()
    for one in (robot, bridge):
        one.end()


@contextmanager
def node_of_rmw_zenoh(endpoint: str, kind: EndpointKind) -> Generator[None]:
    """A node with an end of /chatter as rmw_zenoh_cpp has it, which tells bridges nothing."""
    session = session_at(endpoint)
    node = NodeToken(0, str(session.info.zid()), 0, "/", "stranger")
    end = EndpointToken(node, 1, kind, "/chatter", STRING, NO_HASH, QoSProfile(depth=10))
    shown = [declare_token(session, str(one)) for one in (node, end)]
    yield
    for one in shown:
        one.undeclare()
    close(session)


def test_a_node_of_rmw_zenoh_does_not_hear_one_on_dds_as_one_of_the_studio_does(
    endpoint: str, tester: Node
):
    tester.create_subscription(message(STRING), "/chatter", print, 10)
    with node_of_rmw_zenoh(endpoint, EndpointKind.SUBSCRIPTION), talking_bridge(endpoint):
        told = ends_of(
            endpoint,
            "/chatter",
            lambda link: (
                are_met(link, "/chatter", tester) and len(link.graph.subscriptions("/chatter")) == 2
            ),
        )
    (misfit,) = told.misfits
    assert (misfit.publisher, misfit.subscriber) == ("/talker", "/stranger")
    assert (misfit.way, misfit.heard, misfit.reasons) == ("none", False, ())


def test_a_node_on_dds_does_not_hear_one_of_rmw_zenoh(endpoint: str):
    with (
        node_of_rmw_zenoh(endpoint, EndpointKind.PUBLISHER),
        PretendBridge(endpoint) as bridge,
    ):
        bridge.node("/ear", subscribers=[("/chatter", STRING)])
        bridge.announce("MS/chatter/std_msgs§msg§String/:1::0,10").show()
        told = ends_of(
            endpoint,
            "/chatter",
            lambda link: bool(
                link.graph.publishers("/chatter") and link.graph.subscriptions("/chatter")
            ),
        )
    (misfit,) = told.misfits
    assert (misfit.publisher, misfit.subscriber, misfit.way) == ("/stranger", "/ear", "none")
