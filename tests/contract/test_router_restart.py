"""Real nodes that are older than the router, or outlive it, are seen, asked and heard."""

from __future__ import annotations

import json
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

import pytest
import zenoh

from studio.live.connection.report import examine
from studio.ros.client import DurabilityPolicy, QoSProfile
from studio.ros.graph.diagnosis import unseen_nodes
from studio.ros.graph.graph import Graph
from studio.ros.messages import service
from studio.ros.wire.zenoh import close, insert
from studio.settings import WireChoice
from tests.support.command_line import studio
from tests.support.demos import heard, node_at
from tests.support.ros2_peer import real_node, real_router, ros2, ros2_peer
from tests.support.wire import PATIENCE_S, free_endpoint, open_test_session, router_at, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
ADD = service("example_interfaces/srv/AddTwoInts")
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SERVER = "/peer_server"
ROUTERS = {"ours": router_at, "rmw_zenohd": real_router}


@pytest.fixture(autouse=True)
def _ros2() -> None:
    ros2_peer()


@contextmanager
def bare_router(endpoint: str) -> Generator[None]:
    """A router of others, of the Zenoh that the studio has."""
    config = zenoh.Config()
    insert(config, "mode", '"router"')
    insert(config, "listen/endpoints", json.dumps([endpoint]))
    insert(config, "scouting/multicast/enabled", "false")
    insert(config, "adminspace/enabled", "true")
    session = zenoh.open(config)
    try:
        yield
    finally:
        close(session)


def sees(graph: Graph, count: int = 1) -> None:
    """Wait until a graph has so many servers of the sum, and as many nodes."""

    def is_so() -> bool:
        paths = [node.path for node in graph.nodes()]
        return paths.count(SERVER) == len(graph.servers("/add_two_ints")) == count

    assert graph.wait_for(is_so, PATIENCE_S), [str(node) for node in graph.nodes()]


def assert_answers(node: Node) -> None:
    client = node.create_client(ADD, "/add_two_ints")
    assert client.wait_for_service(PATIENCE_S)
    assert client.call(ADD.Request(a=20, b=22), PATIENCE_S).sum == 42
    node.destroy_client(client)


def test_a_node_that_is_older_than_our_router_is_seen_asked_and_heard_and_its_end_is_told():
    endpoint = free_endpoint()
    with real_node(endpoint, "server") as real:
        real.wait_said("ready")
        with router_at(endpoint), node_at(endpoint) as ours:
            sees(ours.graph)
            assert_answers(ours)
            latched = heard(ours, "std_msgs/msg/String", "/latched", LATCHED)
            wait_until("what it keeps is heard", lambda: [one.data for one in latched] != [])
            real.kill()
            sees(ours.graph, count=0)


@pytest.mark.parametrize("router", ROUTERS)
def test_a_session_and_a_real_node_that_outlive_the_router_meet_at_the_next(router: str):
    endpoint = free_endpoint()
    with ExitStack() as stack:
        first = stack.enter_context(ExitStack())
        first.enter_context(ROUTERS[router](endpoint))
        real = stack.enter_context(real_node(endpoint, "server"))
        ours = stack.enter_context(node_at(endpoint))
        sees(ours.graph)
        first.close()
        sees(ours.graph, count=0)
        stack.enter_context(ROUTERS[router](endpoint))
        sees(ours.graph)
        assert_answers(ours)
        with open_test_session(endpoint) as new, Graph(new) as graph:
            sees(graph)
        real.end()
        sees(ours.graph, count=0)


def test_real_nodes_keep_each_other_when_our_router_goes_and_are_there_once():
    endpoint = free_endpoint()
    with (
        real_node(endpoint, "pub", "--count", "0", "--period", "0.1"),
        real_node(endpoint, "sub", "--count", "0") as listener,
    ):
        with router_at(endpoint), node_at(endpoint) as ours:
            listener.wait_said("matched", current=1)
            assert ours.graph.wait_for(lambda: len(ours.graph.publishers("/chatter")) == 1, 60)
            told = ros2(endpoint, "topic", "info", "/chatter", "--no-daemon")
            assert "Publisher count: 1" in told
            assert "Subscription count: 1" in told
        before = len(listener.all_said("message"))
        wait_until("it hears on", lambda: len(listener.all_said("message")) > before + 10)
        assert [one["current"] for one in listener.all_said("matched")] == [1]


def test_a_router_of_others_that_shows_no_older_node_is_said_with_what_to_do():
    endpoint = free_endpoint()
    with real_node(endpoint, "server") as real:
        real.wait_said("ready")
        with bare_router(endpoint):
            with open_test_session(endpoint) as wire:
                wait_until("its process is found", lambda: unseen_nodes(wire) is not None)
            told = studio("doctor", "--connect", endpoint)
            assert told.code == 1
            assert "1 process publishes (Zenoh 1.8.0), but the router (Zenoh 1.10" in told.out
            assert "refuse to show older nodes" in studio("node", "list", "--connect", endpoint).err
            report = examine(WireChoice("auto", (endpoint,), 0, "jazzy"), ())
            assert (report.verdict, report.nodes, report.unseen) == ("unseen", 0, 1)
