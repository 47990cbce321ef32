"""Our nodes beside zenoh-ros2-sdk, an implementation of rmw_zenoh that is not ours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.graph.graph import Graph
from studio.ros.node.subscription import Losses
from studio.ros.qos import DurabilityPolicy, QoSProfile
from tests.support.demos import node_at
from tests.support.foreign_peer import ForeignPeer, foreign_peer
from tests.support.golden_wire import Distribution
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.node.node import Node
    from studio.ros.node.samples import MessageInfo

pytestmark = pytest.mark.network
LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ADD = "example_interfaces/srv/AddTwoInts"
ADD_HASH = Distribution("jazzy").hash_of(ADD)
LATCHED_TEXT = ":1:,3:,:,:,,"


@pytest.fixture(scope="module")
def peer(endpoint: str, tmp_path_factory: pytest.TempPathFactory) -> Generator[ForeignPeer]:
    with foreign_peer(endpoint, tmp_path_factory.mktemp("home")) as found:
        yield found


@pytest.fixture
def node(endpoint: str) -> Generator[Node]:
    with node_at(endpoint, "ours") as found:
        yield found


@pytest.fixture
def graph(node: Node) -> Generator[Graph]:
    with Graph(node.wire) as found:
        yield found


def publish_until(peer: ForeignPeer, topic: str, heard: Callable[[], bool]) -> None:
    """Have it publish until we are known to it and hear it, as with a plain Zenoh publisher."""

    def publish() -> bool:
        peer.tell("publish", topic=topic, data="again")
        return heard()

    wait_until(f"something comes on {topic}", publish)


def texts_of(node: Node, topic: str, qos: QoSProfile | int = 10) -> list[str]:
    """Subscribe to a topic of texts, and give the list that they will come into."""
    heard: list[str] = []

    def hear(message: Any) -> None:  # noqa: ANN401
        heard.append(message.data)

    node.create_subscription(string(node), topic, hear, qos)
    return heard


def string(node: Node) -> Any:  # noqa: ANN401
    return node.wire.types.message("std_msgs/msg/String")


def test_what_we_publish_is_heard_there(peer: ForeignPeer, node: Node, graph: Graph):
    peer.tell("subscribe", topic="/from_us")
    assert graph.wait_for(lambda: len(graph.subscriptions("/from_us")) == 1, 10)
    publisher = node.create_publisher(string(node), "from_us", 10)
    publisher.publish(string(node)(data="grüße"))
    wait_until("it is heard", lambda: peer.heard("/from_us") == ["grüße"])


def test_what_is_published_there_reaches_us_and_nothing_counts_as_lost(
    peer: ForeignPeer, node: Node
):
    heard: list[tuple[str, int]] = []

    def hear(message: Any, info: MessageInfo) -> None:  # noqa: ANN401
        heard.append((message.data, info["publication_sequence_number"]))

    subscription = node.create_subscription(string(node), "/from_them", hear, 10)
    publish_until(peer, "/from_them", lambda: bool(heard))
    for data in ("one", "two", "three"):
        peer.tell("publish", topic="/from_them", data=data)
    wait_until("all three came", lambda: len(heard) > 3 and heard[-1][0] == "three")
    assert [data for data, _ in heard[-3:]] == ["one", "two", "three"]
    first = heard[0][1]
    assert [number for _, number in heard] == list(range(first, first + len(heard)))
    assert subscription.losses == Losses()


def test_a_gid_that_is_nobodys_names_nobody_and_harms_nothing(
    peer: ForeignPeer, node: Node, graph: Graph
):
    gids: list[bytes] = []

    def hear(_: object, info: MessageInfo) -> None:
        gids.append(info["publisher_gid"])

    node.create_subscription(string(node), "/nameless", hear, 10)
    publish_until(peer, "/nameless", lambda: bool(gids))
    assert graph.wait_for(lambda: len(graph.publishers("/nameless")) == 1, 10)
    assert graph.endpoint_of_gid(gids[0]) is None


def test_the_last_of_a_latched_topic_is_heard_by_one_who_comes_late(
    peer: ForeignPeer, node: Node, graph: Graph
):
    publisher = node.create_publisher(string(node), "/latched", LATCHED)
    for data in ("1", "2", "3", "4"):
        publisher.publish(string(node)(data=data))
    assert graph.wait_for(lambda: len(graph.publishers("/latched")) == 1, 10)
    peer.tell("subscribe", topic="/latched", qos=LATCHED_TEXT)
    # Three are kept and sent; it asks in a way by which Zenoh gives it the newest of a key only.
    wait_until("the last is heard", lambda: peer.heard("/latched") == ["4"])
    publisher.publish(string(node)(data="5"))
    wait_until("the next one is heard once", lambda: peer.heard("/latched") == ["4", "5"])


def test_a_latched_topic_there_keeps_nothing_and_goes_on_with_the_next(
    peer: ForeignPeer, node: Node
):
    peer.tell("publish", topic="/unkept", data="before", qos=LATCHED_TEXT)
    heard = texts_of(node, "/unkept", LATCHED)
    publish_until(peer, "/unkept", lambda: bool(heard))
    assert set(heard) == {"again"}


def test_a_wrong_hash_there_is_silence_which_the_graph_explains(
    peer: ForeignPeer, node: Node, graph: Graph
):
    heard = texts_of(node, "/mistaken")
    wrong = "RIHS01_" + "5f" * 32
    peer.tell("publish_with_hash", topic="/mistaken", data="lost", type_hash=wrong)
    peer.tell("publish", topic="/mistaken_after", data="x")
    assert graph.wait_for(lambda: bool(graph.publishers("/mistaken_after")), 10)
    (theirs,), (ours,) = graph.publishers("/mistaken"), graph.subscriptions("/mistaken")
    assert (theirs.type_name, theirs.type_hash) == ("std_msgs/msg/String", wrong)
    assert ours.type_hash == Distribution("jazzy").hash_of("std_msgs/msg/String")
    assert heard == []


def test_each_sees_the_other_in_its_graph(peer: ForeignPeer, node: Node, graph: Graph):
    node.create_publisher(string(node), "/seen_there", 7)
    peer.tell("publish", topic="/seen_here", data="x", node="seen_peer")
    assert graph.wait_for(lambda: bool(graph.publishers("/seen_here")), 10)
    (theirs,) = graph.publishers("/seen_here")
    assert (theirs.node.path, theirs.type_name) == ("/seen_peer", "std_msgs/msg/String")
    topics = peer.asked("look", "topics")
    assert topics["/seen_there"] == ["std_msgs/msg/String"]


def test_a_service_of_ours_answers_there(peer: ForeignPeer, node: Node):
    def add(request: Any, response: Any) -> Any:  # noqa: ANN401
        response.sum = request.a + request.b
        return response

    service = node.create_service(node.wire.types.service(ADD), "/ours_adds", add)
    asked = {"service": "/ours_adds", "type_hash": ADD_HASH, "a": 2**40, "b": -1}
    assert peer.asked("call", "answered", **asked) == 2**40 - 1
    assert service.refused == 0


def test_a_service_there_answers_us_and_counts_as_served(peer: ForeignPeer, node: Node):
    peer.tell("serve", service="/theirs_adds", type_hash=ADD_HASH)
    kind = node.wire.types.service(ADD)
    client = node.create_client(kind, "/theirs_adds")
    assert client.wait_for_service(10)
    answers = [client.call(kind.Request(a=number, b=2), 10).sum for number in range(5)]
    assert answers == [2, 3, 4, 5, 6]


def test_a_peer_that_ends_leaves_the_graph(
    endpoint: str, graph: Graph, tmp_path_factory: pytest.TempPathFactory
):
    with foreign_peer(endpoint, tmp_path_factory.mktemp("home")) as brief:
        brief.tell("publish", topic="/brief", data="x", node="brief_peer")
        assert graph.wait_for(lambda: graph.node("/brief_peer") is not None, 10)
    assert graph.wait_for(lambda: graph.node("/brief_peer") is None, 10)
    assert graph.publishers("/brief") == []
