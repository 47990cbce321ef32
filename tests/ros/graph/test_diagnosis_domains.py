"""Nodes of every domain are counted, so that whoever sees none learns where they are."""

from __future__ import annotations

from studio.ros.graph.diagnosis import count_nodes, nodes_by_domain
from studio.ros.tokens import NodeToken
from studio.ros.wire.zenoh import declare_token
from tests.support.wire import open_test_session, running_router, wait_until


def test_nodes_of_every_domain_are_counted():
    with (
        running_router() as endpoint,
        open_test_session(endpoint) as studio,
        open_test_session(endpoint, domain=7) as robot,
    ):
        names = ("talker", "listener")
        held = [
            declare_token(robot.zenoh, str(NodeToken(7, robot.zid, robot.next_id(), "/", name)))
            for name in names
        ]
        wait_until("the nodes of domain 7", lambda: nodes_by_domain(studio) == {7: 2})
        assert len(held) == 2


def test_at_a_router_without_nodes_no_domain_has_any():
    with running_router() as endpoint, open_test_session(endpoint) as studio:
        assert nodes_by_domain(studio) == {}


def test_a_token_counts_once_and_what_is_no_node_not_at_all():
    one = str(NodeToken(3, "aa", 0, "/", "talker"))
    assert count_nodes([one, one, "@ros2_lv/3/aa", "junk"]) == {3: 1}
