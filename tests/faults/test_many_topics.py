"""Ten thousand topics at once: all are seen, soon, and all go with their session."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest

from studio.ros.graph.graph import Graph
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.door import declare_token
from tests.support.wire import open_test_session, running_router

if TYPE_CHECKING:
    from studio.ros.wire.session import WireSession

pytestmark = [pytest.mark.network, pytest.mark.timeout(180)]
TOPICS = 10_000
LAST = "/group_99/topic_9999"


def announce(wire: WireSession, count: int) -> list[object]:
    node = NodeToken(0, wire.zid, wire.next_id(), "/", "busy")
    known = wire.types.hash_of("std_msgs/msg/String")
    tokens = [
        EndpointToken(
            node, wire.next_id(), EndpointKind.PUBLISHER, f"/group_{number % 100}/topic_{number}",
            "std_msgs/msg/String", known, QoSProfile(depth=10),
        )
        for number in range(count)
    ]  # fmt: skip
    return [declare_token(wire.zenoh, str(token)) for token in (node, *tokens)]


def test_ten_thousand_topics_are_seen_and_go_with_their_session():
    with (
        running_router() as endpoint,
        open_test_session(endpoint) as watching,
        Graph(watching) as graph,
    ):
        with open_test_session(endpoint) as busy:
            kept = announce(busy, TOPICS)
            assert graph.wait_for(lambda: len(graph.publishers(LAST)) == 1, 60)
            assert graph.settle(60)
            begin_s = time.monotonic()
            assert len(graph.topics()) == TOPICS
            assert len(graph.publishers("/group_7/topic_7")) == 1
            assert time.monotonic() - begin_s < 2
            assert len(kept) == TOPICS + 1
        assert graph.wait_for(lambda: not graph.nodes() and not graph.topics(), 60)
