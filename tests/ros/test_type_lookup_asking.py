from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import TypeDescriptionError
from studio.ros.action import ActionClient, ActionServer
from studio.ros.node.spinning import call_service
from studio.ros.type_lookup import learn_from
from studio.ros.types.library import TypeLibrary
from studio.ros.types.type_descriptions import DESCRIPTION_SERVICE_TYPE, fill_description
from tests.support.demos import node_at
from tests.support.goals import finished
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
TEXTS = {
    "my_pkg/msg/Inner": "# Of the peer.\nuint8 MAX=7\nfloat32[3] values # three\n",
    "my_pkg/msg/Outer": "std_msgs/Header header\nInner[] inner\n",
    "my_pkg/srv/Ask": "Inner inner\n---\nbool good\n",
    "my_pkg/action/Go": "Inner inner\n---\nbool good\n---\nfloat32 done\n",
}


class Peers:
    """A node with types of its own, and one that has never heard of them."""

    def __init__(self, peer: Node, node: Node) -> None:
        self.peer, self.node = peer, node
        types = peer.wire.types
        peer.create_publisher(types.message("my_pkg/msg/Outer"), "outer", 10)
        peer.create_service(types.service("my_pkg/srv/Ask"), "ask", lambda _, response: response)
        ActionServer(peer, types.action("my_pkg/action/Go"), "go", lambda goal: goal.abort())

    def learn(self, name: str) -> list[str]:
        return learn_from(self.node, self.endpoint(name))

    def endpoint(self, name: str) -> GraphEndpoint:
        graph = self.node.graph

        def found() -> list[GraphEndpoint]:
            return [*graph.publishers(name), *graph.servers(name)]

        wait_until(f"{name} is there", lambda: bool(found()))
        return found()[0]


@pytest.fixture
def peers() -> Generator[Peers]:
    types = TypeLibrary("jazzy")
    types.add_texts(TEXTS)
    with (
        running_router() as endpoint,
        node_at(endpoint, "peer", types) as peer,
        node_at(endpoint, "node", TypeLibrary("jazzy")) as node,
    ):
        yield Peers(peer, node)


def test_a_message_is_learned_from_the_node_that_publishes_it(peers: Peers):
    assert peers.learn("/outer") == ["my_pkg/msg/Inner", "my_pkg/msg/Outer"]
    types = peers.node.wire.types
    assert types.text_of("my_pkg/msg/Inner") == TEXTS["my_pkg/msg/Inner"]
    assert types.hash_of("my_pkg/msg/Outer") == peers.endpoint("/outer").type_hash
    assert peers.learn("/outer") == []


def test_what_was_learned_is_read(peers: Peers):
    peers.learn("/outer")
    heard: list[Any] = []
    node, peer = peers.node, peers.peer
    node.create_subscription(node.wire.types.message("my_pkg/msg/Outer"), "back", heard.append, 10)
    wait_until("it listens", lambda: bool(peer.graph.subscriptions("/back")))
    outer, inner = (peer.wire.types.message(f"my_pkg/msg/{name}") for name in ("Outer", "Inner"))
    peer.create_publisher(outer, "back", 10).publish(outer(inner=[inner(values=[1, 2, 3])]))
    wait_until("it is heard", lambda: bool(heard))
    assert list(heard[0].inner[0].values) == [1.0, 2.0, 3.0]


def test_a_service_is_learned_and_called(peers: Peers):
    assert peers.learn("/ask") == ["my_pkg/msg/Inner", "my_pkg/srv/Ask"]
    kind = peers.node.wire.types.service("my_pkg/srv/Ask")
    client = peers.node.create_client(kind, "ask")
    assert call_service(peers.node, client, kind.Request()).good is False


def test_an_action_is_learned_from_any_of_its_parts(peers: Peers):
    assert peers.learn("/go/_action/feedback") == ["my_pkg/action/Go", "my_pkg/msg/Inner"]
    kind = peers.node.wire.types.action("my_pkg/action/Go")
    assert kind.type_hash == peers.peer.wire.types.hash_of("my_pkg/action/Go")
    answer = finished(ActionClient(peers.node, kind, "go").send_goal_async(kind.Goal()))
    assert answer.accepted


def test_a_hash_that_the_node_does_not_have_is_refused_by_it(peers: Peers):
    endpoint = replace(peers.endpoint("/outer"), type_hash="RIHS01_" + "0" * 64)
    with pytest.raises(TypeDescriptionError, match="its node says: my_pkg/msg/Outer has the hash"):
        learn_from(peers.node, endpoint)


def test_a_node_of_humble_describes_nothing(peers: Peers):
    endpoint = replace(peers.endpoint("/outer"), type_hash="TypeHashNotSupported")
    with pytest.raises(TypeDescriptionError, match="Humble"):
        learn_from(peers.node, endpoint)


def test_a_node_that_lies_teaches_nothing(peers: Peers):
    node, peer = peers.node, peers.peer
    kind = peer.wire.types.service(DESCRIPTION_SERVICE_TYPE)

    def lie(request: Any, response: Any) -> Any:  # noqa: ANN401
        response = fill_description(peer.wire.types, request, response)
        response.type_description.type_description.fields[0].name = "wrong"
        return response

    peer.create_service(kind, "/liar/get_type_description", lie)
    honest = peers.endpoint("/outer")
    endpoint = replace(honest, node=replace(honest.node, path="/liar"))
    with pytest.raises(TypeDescriptionError, match="its hash is"):
        learn_from(node, endpoint)
    assert "my_pkg/msg/Outer" not in node.wire.types.names()
