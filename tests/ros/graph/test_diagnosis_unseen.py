"""Processes that publish, though the router shows no token of theirs, are counted and explained."""

from __future__ import annotations

import json
from contextlib import contextmanager
from importlib.metadata import version
from typing import TYPE_CHECKING

import pytest
import zenoh

from studio.ros.graph.diagnosis import unseen_nodes, why_unseen
from studio.ros.wire.zenoh import close, declare_token, insert
from tests.support.wire import open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network
ROSOUT = "7/rosout/rcl_interfaces::msg::dds_::Log_/RIHS01_00"


@contextmanager
def publishing(endpoint: str) -> Generator[zenoh.Session]:
    """A process as one of rmw_zenoh is, whose node nobody is told of."""
    config = zenoh.Config()
    insert(config, "mode", '"peer"')
    insert(config, "connect/endpoints", json.dumps([endpoint]))
    insert(config, "listen/endpoints", "[]")
    insert(config, "scouting/multicast/enabled", "false")
    insert(config, "adminspace/enabled", "true")
    session = zenoh.open(config)
    publisher = session.declare_publisher(ROSOUT)
    try:
        yield session
        del publisher
    finally:
        close(session)


def test_a_process_that_publishes_and_shows_no_node_is_found_with_versions():
    with (
        running_router() as endpoint,
        publishing(endpoint),
        open_test_session(endpoint, domain=7) as wire,
    ):
        wait_until("it is found", lambda: unseen_nodes(wire) is not None)
        found = unseen_nodes(wire)
        assert found is not None
        own = version("eclipse-zenoh")
        assert (found.count, found.versions, found.router_versions) == (1, (own,), (own,))
        assert f"1 process publishes (Zenoh {own}), but the router" in why_unseen(found)


def test_nothing_is_found_where_the_node_is_shown_or_in_another_domain():
    with (
        running_router() as endpoint,
        publishing(endpoint) as process,
        open_test_session(endpoint, domain=7) as wire,
        open_test_session(endpoint, domain=8) as other,
    ):
        wait_until("it is found", lambda: unseen_nodes(wire) is not None)
        assert unseen_nodes(other) is None
        token = f"@ros2_lv/7/{process.info.zid()}/0/0/NN/%/%/shown"
        declared = declare_token(process, token)
        assert unseen_nodes(wire) is None
        declared.undeclare()
