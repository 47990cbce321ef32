from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.lifecycle import LifecycleNode
from studio.ros.lifecycle.client import LifecycleClient
from tests.support.demos import heard, node_at
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network


@pytest.fixture
def nodes() -> Generator[tuple[LifecycleNode, Node]]:
    with (
        running_router() as endpoint,
        node_at(endpoint, "host") as host,
        node_at(endpoint, "asking") as asking,
    ):
        managed = LifecycleNode("managed", context=host.context)
        assert host.executor is not None
        host.executor.add_node(managed)
        yield managed, asking


def labels(descriptions: list[Any]) -> list[tuple[int, str, str, str]]:
    return [
        (one.transition.id, one.transition.label, one.start_state.label, one.goal_state.label)
        for one in descriptions
    ]


def test_a_managed_node_tells_its_state_and_what_it_can_do(nodes: tuple[LifecycleNode, Node]):
    with LifecycleClient(nodes[1], "managed") as client:
        state = client.state()
        assert (state.id, state.label) == (1, "unconfigured")
        assert labels(client.available_transitions()) == [
            (1, "configure", "unconfigured", "configuring"),
            (5, "shutdown", "unconfigured", "shuttingdown"),
        ]
        assert len(client.transition_graph()) == 25
        assert [one.label for one in client.available_states()][:5] == [
            "unknown", "unconfigured", "inactive", "active", "finalized",
        ]  # fmt: skip


def test_a_managed_node_takes_transitions_by_label_and_by_number(
    nodes: tuple[LifecycleNode, Node],
):
    with LifecycleClient(nodes[1], "managed") as client:
        assert client.change("configure")
        assert client.change(3)
        assert client.state().label == "active"
        assert client.change("shutdown")
        assert client.state().label == "finalized"


@pytest.mark.parametrize("transition", ["activate", "nonsense", 3, 99, 0])
def test_what_does_not_begin_here_is_refused(
    nodes: tuple[LifecycleNode, Node], transition: str | int
):
    with LifecycleClient(nodes[1], "managed") as client:
        assert not client.change(transition)
        assert client.state().label == "unconfigured"


def test_each_step_is_told_to_all(nodes: tuple[LifecycleNode, Node]):
    managed, asking = nodes
    events = heard(asking, "lifecycle_msgs/msg/TransitionEvent", "/managed/transition_event")
    wait_until("heard", lambda: bool(managed.graph.subscriptions("/managed/transition_event")))
    with LifecycleClient(asking, "managed") as client:
        client.change("configure")
    wait_until("both steps", lambda: len(events) == 2)
    assert labels(events) == [
        (1, "configure", "unconfigured", "configuring"),
        (10, "transition_success", "configuring", "inactive"),
    ]
    assert events[0].timestamp > 1_600_000_000_000_000_000
