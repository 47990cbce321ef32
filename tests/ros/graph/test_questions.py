"""Servers are asked whether they answer, those of rmw_zenoh and those behind a bridge to DDS."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from studio.ros.cdr import codec_of
from studio.ros.graph.graph import Graph
from studio.ros.graph.questions import Question
from studio.ros.messages import service
from tests.support.demos import node_at
from tests.support.pretend_bridge import PretendBridge
from tests.support.wire import PATIENCE_S, open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.wire.session import WireSession

pytestmark = pytest.mark.network
ADD = "example_interfaces/srv/AddTwoInts"
AddTwoInts = service(ADD)
REQUEST = bytes(codec_of(AddTwoInts.Request).encode(AddTwoInts.Request(a=1, b=2)))


class Asker(NamedTuple):
    """A session with its graph."""

    endpoint: str
    wire: WireSession
    graph: Graph

    def server(self) -> GraphEndpoint:
        """Who serves /add, once somebody does."""
        wait_until("/add is served", lambda: bool(self.graph.servers("/add")))
        return self.graph.servers("/add")[0]


@pytest.fixture
def asker() -> Generator[Asker]:
    with running_router() as endpoint, open_test_session(endpoint) as wire:
        graph = Graph(wire)
        yield Asker(endpoint, wire, graph)
        graph.close()


def test_a_node_of_rmw_zenoh_answers(asker: Asker):
    with node_at(asker.endpoint, "adder") as node:
        node.create_service(AddTwoInts, "/add", lambda _, response: response)
        question = Question(asker.wire, asker.server(), REQUEST, PATIENCE_S)
        wait_until("it answers", question.is_answered)
        question.close()
        assert question.is_answered()


def test_a_node_on_dds_is_asked_by_the_key_of_its_bridge_without_an_attachment(asker: Asker):
    asked: list[tuple[bytes, object]] = []

    def answer(query: Any) -> None:  # noqa: ANN401
        asked.append((query.payload.to_bytes(), query.attachment))
        query.reply("add", b"0000")

    with PretendBridge(asker.endpoint) as bridge:
        bridge.node("/adder", service_servers=[("/add", ADD)])
        bridge.announce("SS/add/example_interfaces§srv§AddTwoInts").show()
        bridge.serve("add", answer)
        question = Question(asker.wire, asker.server(), REQUEST, PATIENCE_S)
        wait_until("it answers", question.is_answered)
        question.close()
    assert asked == [(REQUEST, None)]


def test_a_server_that_is_gone_does_not_answer(asker: Asker):
    with node_at(asker.endpoint, "adder") as node:
        node.create_service(AddTwoInts, "/add", lambda _, response: response)
        server = asker.server()
    wait_until("it is gone", lambda: not asker.graph.servers("/add"))
    question = Question(asker.wire, server, REQUEST, PATIENCE_S)
    assert not question.is_answered()
    question.close()
    assert not question.is_answered()
