"""The graph over real Zenoh: who comes, goes, is killed, and returns with the router."""

from __future__ import annotations

import subprocess
import sys
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from studio.ros.graph.graph import Graph
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.zenoh import declare_token
from tests.support.wire import (
    PATIENCE_S,
    free_endpoint,
    open_test_session,
    router_at,
    show_endpoints,
    wait_until,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Declaration

STRING = "std_msgs/msg/String"


@pytest.fixture
def robot(endpoint: str) -> Iterator[WireSession]:
    with open_test_session(endpoint) as wire:
        yield wire


@pytest.fixture
def graph(endpoint: str) -> Iterator[Graph]:
    with open_test_session(endpoint) as wire, Graph(wire) as found:
        yield found


def node_of(wire: WireSession, name: str = "talker", namespace: str = "/") -> NodeToken:
    return NodeToken(wire.domain, wire.zid, wire.next_id(), namespace, name)


def endpoint_of(
    wire: WireSession,
    node: NodeToken,
    name: str,
    kind: EndpointKind = EndpointKind.PUBLISHER,
    type_name: str = STRING,
) -> EndpointToken:
    return EndpointToken(
        node, wire.next_id(), kind, name, type_name, "RIHS01_df", QoSProfile(depth=10)
    )


def show(wire: WireSession, *tokens: NodeToken | EndpointToken) -> list[Declaration]:
    return [declare_token(wire.zenoh, str(token)) for token in tokens]


def test_a_node_and_its_publisher_appear_with_all_that_they_say(robot: WireSession, graph: Graph):
    node = node_of(robot, namespace="/arm")
    held = show(robot, node, endpoint_of(robot, node, "/arm/chatter"))
    assert graph.wait_for(lambda: graph.topics() == [("/arm/chatter", [STRING])], PATIENCE_S)
    (publisher,) = graph.publishers("/arm/chatter")
    assert (publisher.node_name, publisher.node_namespace) == ("talker", "/arm")
    assert (publisher.topic_type, publisher.topic_type_hash) == (STRING, "RIHS01_df")
    assert publisher.qos_profile.depth == 10
    assert graph.count(EndpointKind.PUBLISHER, "/arm/chatter") == 1
    assert graph.count(EndpointKind.SUBSCRIPTION, "/arm/chatter") == 0
    assert graph.endpoint_of_gid(publisher.gid) == publisher
    assert held


def test_who_looks_later_settles_on_what_stands(robot: WireSession, endpoint: str):
    node = node_of(robot)
    held = show(robot, node, *(endpoint_of(robot, node, f"/topic_{at}") for at in range(200)))
    with open_test_session(endpoint) as wire, Graph(wire) as first:
        assert first.wait_for(lambda: len(first.topics()) == 200, PATIENCE_S)
        with Graph(wire) as second:
            assert second.settle(PATIENCE_S)
            assert second.topics() == first.topics()
    assert len(held) == 201


def test_an_endpoint_that_is_taken_back_vanishes(robot: WireSession, graph: Graph):
    node = node_of(robot)
    _, publisher = show(robot, node, endpoint_of(robot, node, "/chatter"))
    assert graph.wait_for(lambda: bool(graph.publishers("/chatter")), PATIENCE_S)
    publisher.undeclare()
    assert graph.wait_for(lambda: not graph.publishers("/chatter"), PATIENCE_S)
    assert graph.node("/talker") is not None


def test_nodes_of_another_domain_are_not_there(robot: WireSession, endpoint: str, graph: Graph):
    with open_test_session(endpoint, domain=7) as other:
        held = [*show(other, node_of(other, "far")), *show(robot, node_of(robot, "near"))]
        assert graph.wait_for(lambda: graph.node("/near") is not None, PATIENCE_S)
        assert graph.node("/far") is None
    assert len(held) == 2


def test_two_nodes_of_one_name_are_told(robot: WireSession, endpoint: str, graph: Graph):
    with open_test_session(endpoint) as other:
        held = [*show(robot, node_of(robot)), *show(other, node_of(other))]
        assert graph.wait_for(lambda: graph.duplicate_nodes() == {"/talker": 2}, PATIENCE_S)
    assert graph.wait_for(lambda: not graph.duplicate_nodes(), PATIENCE_S)
    assert held


def test_an_action_is_known_by_its_services(robot: WireSession, graph: Graph):
    node = node_of(robot, "turtle")
    parts = {"send_goal": "_SendGoal", "get_result": "_GetResult"}
    held = show(
        robot,
        node,
        *(
            endpoint_of(
                robot,
                node,
                f"/turn/_action/{part}",
                EndpointKind.SERVICE,
                f"turtlesim/action/Turn{suffix}",
            )
            for part, suffix in parts.items()
        ),
    )
    turn = [("/turn", ["turtlesim/action/Turn"])]
    assert graph.wait_for(lambda: graph.actions() == turn, PATIENCE_S)
    assert [one.name for one in graph.action_servers("/turn")] == ["turtle"]
    assert graph.action_clients("/turn") == []
    assert held


def test_a_service_is_waited_for_by_its_type_too(robot: WireSession, graph: Graph):
    assert not graph.wait_for_service("/add", timeout_s=0)
    node = node_of(robot, "adder")
    add = "example_interfaces/srv/AddTwoInts"
    held = show(robot, node, endpoint_of(robot, node, "/add", EndpointKind.SERVICE, add))
    assert graph.wait_for_service("/add", add, PATIENCE_S)
    assert not graph.has_server("/add", "std_srvs/srv/Trigger")
    assert held


def test_a_listener_hears_of_changes_until_it_is_taken_back(robot: WireSession, graph: Graph):
    versions: list[int] = []
    end = graph.on_change(lambda: versions.append(graph.version))
    held = show(robot, node_of(robot, "one"))
    assert graph.wait_for(lambda: graph.node("/one") is not None, PATIENCE_S)
    wait_until("it is told", lambda: bool(versions))  # after those who wait
    end()
    last = graph.version
    held += show(robot, node_of(robot, "two"))
    assert graph.wait_for(lambda: graph.node("/two") is not None, PATIENCE_S)
    assert max(versions) <= last
    assert held


def test_tokens_that_are_none_are_counted(robot: WireSession, graph: Graph):
    held = declare_token(robot.zenoh, "@ros2_lv/0/aa/0/0/XX/%/%/talker")
    assert graph.wait_for(lambda: graph.malformed[0] == 1, PATIENCE_S)
    held.undeclare()


@pytest.mark.parametrize("each", [100, pytest.param(1_000, marks=pytest.mark.sweep)])
def test_thousands_of_topics_of_ten_sessions_are_all_seen_and_all_go(
    endpoint: str, graph: Graph, each: int
):
    with ExitStack() as stack:
        held: list[Declaration] = []
        for at in range(10):
            wire = stack.enter_context(open_test_session(endpoint))
            held += show_endpoints(wire, each, f"robot_{at}")
        assert graph.wait_for(lambda: len(graph.topics()) == 10 * each, PATIENCE_S)
        assert len(graph.nodes()) == 10
        assert len(held) == 10 * (each + 1)
    assert graph.wait_for(lambda: not graph.topics(), PATIENCE_S)


NODE_OF_ITS_OWN = """
import sys
from studio.ros.tokens import NodeToken
from studio.ros.wire.zenoh import declare_token
from tests.support.wire import open_test_session
wire = open_test_session(sys.argv[1])
token = declare_token(wire.zenoh, str(NodeToken(0, wire.zid, wire.next_id(), "/", "victim")))
sys.stdin.read()
"""


def test_a_node_that_is_killed_vanishes(endpoint: str, graph: Graph):
    process = subprocess.Popen(
        [sys.executable, "-c", NODE_OF_ITS_OWN, endpoint], stdin=subprocess.PIPE
    )
    with process:
        try:
            assert graph.wait_for(lambda: graph.node("/victim") is not None, PATIENCE_S)
        finally:
            process.kill()
    assert graph.wait_for(lambda: graph.node("/victim") is None, PATIENCE_S)


def test_everything_goes_with_the_router_and_returns_with_the_next():
    endpoint = free_endpoint()
    with ExitStack() as stack:
        first = stack.enter_context(router_at(endpoint))
        robot = stack.enter_context(open_test_session(endpoint))
        graph = stack.enter_context(Graph(stack.enter_context(open_test_session(endpoint))))
        node = node_of(robot)
        held = show(robot, node, endpoint_of(robot, node, "/chatter"))
        assert graph.wait_for(lambda: bool(graph.topics()), PATIENCE_S)
        first.close()
        assert graph.wait_for(lambda: not graph.nodes(), PATIENCE_S)
        stack.enter_context(router_at(endpoint))
        assert graph.wait_for(lambda: bool(graph.topics()), PATIENCE_S)
        assert [one.name for one in graph.nodes()] == ["talker"]
        assert len(held) == 2


def test_a_closed_graph_keeps_what_it_knew_and_may_be_closed_again(
    robot: WireSession, graph: Graph
):
    held = show(robot, node_of(robot))
    assert graph.wait_for(lambda: [one.name for one in graph.nodes()] == ["talker"], PATIENCE_S)
    graph.close()
    graph.close()
    assert [one.name for one in graph.nodes()] == ["talker"]
    assert held


def test_what_the_session_shows_itself_is_there_at_once_and_once(endpoint: str):
    with open_test_session(endpoint) as wire:
        node = node_of(wire)
        before = wire.own_tokens.show(str(node))
        with Graph(wire) as graph:
            assert [one.path for one in graph.nodes()] == ["/talker"]
            end = endpoint_of(wire, node, "/chatter")
            shown = wire.own_tokens.show(str(end))
            assert graph.count(EndpointKind.PUBLISHER, "/chatter") == 1
            assert graph.settle()
            assert graph.count(EndpointKind.PUBLISHER, "/chatter") == 1
            assert graph.token_count == 2
            shown.undeclare()
            assert graph.count(EndpointKind.PUBLISHER, "/chatter") == 0
            assert graph.settle()
            before.undeclare()
            assert graph.nodes() == []
            assert graph.token_count == 0


def test_what_is_shown_and_taken_back_again_and_again_does_not_come_back(endpoint: str):
    with open_test_session(endpoint) as wire, Graph(wire) as graph:
        node = node_of(wire)
        shown = wire.own_tokens.show(str(node))
        for _ in range(50):
            wire.own_tokens.show(str(endpoint_of(wire, node, "/chatter"))).undeclare()
            assert graph.count(EndpointKind.PUBLISHER, "/chatter") == 0
        version = graph.version
        last = wire.own_tokens.show(str(endpoint_of(wire, node, "/last")))
        assert graph.wait_for(lambda: graph.version > version + 1, PATIENCE_S)
        assert graph.settle()
        assert graph.topics() == [("/last", [STRING])]
        last.undeclare()
        shown.undeclare()
