"""The course's row on managed nodes, L1: the lifecycle talker in a process of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.client import message
from tests.support.demos import call, heard, node_at, running_demo
from tests.support.wire import running_router, wait_until

if TYPE_CHECKING:
    from studio.ros.client import Node

pytestmark = pytest.mark.network
STEPS = (
    ("configure", "inactive"),
    ("activate", "active"),
    ("deactivate", "inactive"),
    ("cleanup", "unconfigured"),
    ("shutdown", "finalized"),
)


def state_of(node: Node) -> str:
    answer = call(node, "lifecycle_msgs/srv/GetState", "/lc_talker/get_state")
    return answer.current_state.label


def test_l1_the_talker_walks_the_four_primary_states_and_talks_only_while_active():
    with (
        running_router() as router,
        node_at(router) as node,
        running_demo(router, "lifecycle_talker"),
    ):
        said = heard(node, "std_msgs/msg/String", "/lifecycle_chatter")
        assert state_of(node) == "unconfigured"
        for label, state in STEPS:
            transition = message("lifecycle_msgs/msg/Transition")(label=label)
            change = "lifecycle_msgs/srv/ChangeState"
            assert call(node, change, "/lc_talker/change_state", transition=transition).success
            assert state_of(node) == state
            if state == "active":
                wait_until("it talks", lambda: bool(said))
                assert said[0].data.startswith("Lifecycle HelloWorld #")
            elif label == "configure":
                assert not said
