from __future__ import annotations

import pytest

from studio.ros.lifecycle import (
    LifecycleNode,
    LifecycleState,
    ManagedEntity,
    StateId,
    TransitionCallbackReturn,
)
from studio.ros.node.event_handler import PublisherEventCallbacks
from tests.support.demos import heard, node_at
from tests.support.wire import running_router, wait_until


def test_an_entity_agrees_to_every_transition_unless_it_is_told_otherwise():
    entity, state = ManagedEntity(), LifecycleState.of(StateId.INACTIVE)
    names = ("configure", "cleanup", "shutdown", "activate", "deactivate", "error")
    for name in names:
        assert getattr(entity, f"on_{name}")(state) is TransitionCallbackReturn.SUCCESS


def test_a_state_is_told_by_label_and_number():
    assert LifecycleState.of(StateId.CLEANINGUP) == ("cleaningup", 11)


@pytest.mark.network
def test_a_lifecycle_publisher_sends_only_while_its_node_is_active():
    with running_router() as endpoint, node_at(endpoint, "a") as host, node_at(endpoint) as other:
        said = heard(other, "std_msgs/msg/String", "/chatter")
        node = LifecycleNode("talker", context=host.context)
        wait_until("heard", lambda: bool(node.graph.subscriptions("/chatter")))
        string = node.wire.types.message("std_msgs/msg/String")
        callbacks = PublisherEventCallbacks(matched=print)
        publisher = node.create_lifecycle_publisher(
            string, "chatter", 10, event_callbacks=callbacks
        )
        assert len(publisher.events) == 1
        node.trigger_configure()
        for number in range(4):
            publisher.publish(string(data=str(number)))
            assert publisher.is_activated == bool(number % 2)
            (node.trigger_deactivate if number % 2 else node.trigger_activate)()
        wait_until("the last that was sent", lambda: len(said) == 2)
        assert [one.data for one in said] == ["1", "3"]
        assert node.destroy_lifecycle_publisher(publisher)
        assert not node.destroy_lifecycle_publisher(publisher)
