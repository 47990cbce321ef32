"""The router is killed and comes back: topics, services and the graph return by themselves."""

from __future__ import annotations

import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.client import DurabilityPolicy, QoSProfile
from studio.ros.messages import message, service
from tests.support.demos import heard, node_at
from tests.support.wire import PATIENCE_S, free_endpoint, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.node.node import Node

pytestmark = pytest.mark.network
STRING = message("std_msgs/msg/String")
ADD = service("example_interfaces/srv/AddTwoInts")
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ROUTER = """
import sys
from studio.ros.wire.router import run_router
run_router(sys.argv[1], lambda endpoint: print(endpoint, flush=True))
"""


@contextmanager
def router_process(endpoint: str) -> Generator[subprocess.Popen[str]]:
    words = [sys.executable, "-c", ROUTER, endpoint]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline().strip() == endpoint
            yield process
        finally:
            process.kill()


@contextmanager
def killed_once(endpoint: str) -> Generator[tuple[Node, Node]]:
    """Two nodes that were in touch, after their router was killed and another one started."""
    with (
        router_process(endpoint) as first,
        node_at(endpoint, "one") as one,
        node_at(endpoint, "two") as two,
    ):
        two.create_service(ADD, "/add", add)
        two.create_publisher(STRING, "/kept", LATCHED).publish(STRING(data="kept"))
        assert one.graph.wait_for(lambda: one.graph.node("/two") is not None, PATIENCE_S)
        first.kill()
        first.wait()
        assert one.graph.wait_for(lambda: one.graph.node("/two") is None, PATIENCE_S)
        with router_process(endpoint):
            yield one, two


def add(request: Any, response: Any) -> Any:  # noqa: ANN401
    response.sum = request.a + request.b
    return response


def test_all_comes_back_by_itself_after_the_router_was_killed():
    with killed_once(free_endpoint()) as (one, two):
        graph = one.graph
        assert graph.wait_for(lambda: graph.node("/two") is not None, PATIENCE_S)
        assert graph.wait_for(lambda: len(graph.servers("/add")) == 1, PATIENCE_S)
        came = heard(one, "std_msgs/msg/String", "/again")
        publisher = two.create_publisher(STRING, "/again", 10)

        def publish() -> bool:
            publisher.publish(STRING(data="x"))
            return bool(came)

        wait_until("a message comes", publish)
        client = one.create_client(ADD, "/add")
        assert client.wait_for_service(PATIENCE_S)
        assert client.call(ADD.Request(a=1, b=2), PATIENCE_S).sum == 3
        kept = heard(one, "std_msgs/msg/String", "/kept", LATCHED)
        wait_until(
            "what was latched before comes", lambda: [each.data for each in kept] == ["kept"]
        )


def test_nodes_end_in_time_while_their_router_is_gone():
    endpoint = free_endpoint()
    with router_process(endpoint) as router, node_at(endpoint) as node:
        node.create_service(ADD, "/add", add)
        publisher = node.create_publisher(STRING, "/lost", 10)
        router.kill()
        router.wait()
        for _ in range(100):
            publisher.publish(STRING(data="nobody hears"))
