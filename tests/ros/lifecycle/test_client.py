from __future__ import annotations

import pytest

from studio.errors import NotServedError
from studio.ros.lifecycle.client import LifecycleClient
from tests.support.demos import node_at, running_demo
from tests.support.wire import running_router

pytestmark = pytest.mark.network


def test_a_managed_node_in_another_process_walks_as_it_is_told():
    with (
        running_router() as endpoint,
        running_demo(endpoint, "lifecycle_talker"),
        node_at(endpoint) as node,
        LifecycleClient(node, "/lc_talker", timeout_s=20.0) as client,
    ):
        for transition, state in (
            ("configure", "inactive"), ("activate", "active"), ("deactivate", "inactive"),
            ("cleanup", "unconfigured"), ("shutdown", "finalized"),
        ):  # fmt: skip
            assert client.change(transition)
            assert client.state().label == state


def test_a_node_that_is_no_managed_one_is_said_by_name():
    with (
        running_router() as endpoint,
        node_at(endpoint) as node,
        LifecycleClient(node, "/tester", timeout_s=0.1) as client,
        pytest.raises(NotServedError, match="/tester/get_state"),
    ):
        client.state()
