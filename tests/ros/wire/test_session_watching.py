"""A session knows when its router goes and returns, and all that it declared returns with it."""

from __future__ import annotations

import threading
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest
import zenoh

from studio.ros.graph.graph import Graph
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.session import RouterWatch
from studio.ros.wire.zenoh import (
    declare_publisher,
    declare_querier,
    declare_queryable,
    declare_subscription,
    declare_token,
)
from tests.support.wire import (
    PATIENCE_S,
    free_endpoint,
    open_test_session,
    router_at,
    wait_until,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Incoming, Query


class Place:
    """A router that can be killed and started anew at the same endpoint."""

    def __init__(self) -> None:
        self.endpoint = free_endpoint()
        self.router = router_at(self.endpoint)

    def restart(self, *watches: RouterWatch) -> None:
        self.router.close()
        assert all(watch.wait_for(connected=False, timeout_s=PATIENCE_S) for watch in watches)
        self.router = router_at(self.endpoint)
        assert all(watch.wait_for(connected=True, timeout_s=PATIENCE_S) for watch in watches)


@pytest.fixture
def place() -> Iterator[Place]:
    found = Place()
    yield found
    found.router.close()


@pytest.fixture
def pair(place: Place) -> Iterator[tuple[WireSession, WireSession]]:
    with open_test_session(place.endpoint) as one, open_test_session(place.endpoint) as other:
        yield one, other


def restart(place: Place, pair: tuple[WireSession, WireSession]) -> None:
    with RouterWatch(pair[0]) as one, RouterWatch(pair[1]) as other:
        place.restart(one, other)


def test_a_watch_tells_that_the_router_went_and_came_back(
    place: Place, pair: tuple[WireSession, WireSession]
):
    told: list[bool] = []
    with RouterWatch(pair[0], told.append) as watch:
        assert watch.is_connected
        place.restart(watch)
        wait_until("both changes to be told", lambda: told == [False, True])


def test_a_closed_watch_tells_no_more(place: Place, pair: tuple[WireSession, WireSession]):
    told: list[bool] = []
    RouterWatch(pair[0], told.append).close()
    with RouterWatch(pair[0]) as watch:
        place.restart(watch)
    assert not told


def test_publishers_and_subscriptions_return(place: Place, pair: tuple[WireSession, WireSession]):
    publisher = declare_publisher(pair[0].zenoh, "0/a", blocking=False, reliable=True)
    samples = declare_subscription(pair[1].zenoh, "0/a", 10, reliable=True)
    restart(place, pair)

    def arrives() -> bool:
        publisher.put(b"again", attachment=b"x")
        return samples.try_recv() is not None

    wait_until("a sample by the new router", arrives)


def test_latched_samples_reach_who_comes_after_the_restart(
    place: Place, pair: tuple[WireSession, WireSession]
):
    publisher = declare_publisher(pair[0].zenoh, "0/map", blocking=False, reliable=True, kept=1)
    publisher.put(b"map", attachment=b"x")
    restart(place, pair)
    samples = declare_subscription(pair[1].zenoh, "0/map", 10, reliable=True, wanted=1)
    wait_until("the latched sample", lambda: samples.try_recv() is not None)


def test_a_subscription_gets_what_was_latched_while_the_router_was_away(
    place: Place, pair: tuple[WireSession, WireSession]
):
    samples = declare_subscription(pair[1].zenoh, "0/map", 10, reliable=True, wanted=1)
    publisher = declare_publisher(pair[0].zenoh, "0/map", blocking=False, reliable=True, kept=1)
    with RouterWatch(pair[0]) as one, RouterWatch(pair[1]) as other:
        place.router.close()
        assert one.wait_for(connected=False, timeout_s=PATIENCE_S)
        assert other.wait_for(connected=False, timeout_s=PATIENCE_S)
        publisher.put(b"late", attachment=b"x")
        place.router = router_at(place.endpoint)
    wait_until("the latched sample", lambda: samples.try_recv() is not None)


def test_queryables_return_with_their_askers(place: Place, pair: tuple[WireSession, WireSession]):
    asked = declare_queryable(pair[0].zenoh, "0/add", 10)
    asking = declare_querier(pair[1].zenoh, "0/add", PATIENCE_S)
    restart(place, pair)
    ended = threading.Event()
    server = threading.Thread(target=answer, args=(asked, ended))
    server.start()

    def is_answered() -> bool:
        replies = asking.get(zenoh.handlers.FifoChannel(16), payload=b"1", attachment=b"x")
        return any(reply.ok is not None for reply in replies)

    try:
        wait_until("an answer by the new router", is_answered)
    finally:
        ended.set()
        asked.undeclare()
        server.join(PATIENCE_S)


def answer(asked: Incoming[Query], ended: threading.Event) -> None:
    for query in asked:
        if ended.is_set():
            return
        query.reply(query.key_expr, b"2", attachment=b"y")
        query.drop()


def test_tokens_return_and_their_endpoints_name_the_same_sender(
    place: Place, pair: tuple[WireSession, WireSession]
):
    robot, studio = pair
    node = NodeToken(0, robot.zid, robot.next_id(), "/", "talker")
    endpoints = [
        EndpointToken(
            node,
            robot.next_id(),
            kind,
            "/chatter",
            "std_msgs/msg/String",
            "RIHS01_df",
            QoSProfile(),
        )
        for kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    ]
    held = [declare_token(robot.zenoh, str(token)) for token in (node, *endpoints)]
    with ExitStack() as stack:
        graph = stack.enter_context(Graph(studio))
        assert graph.wait_for(lambda: len(seen(graph)) == 2, PATIENCE_S)
        before = seen(graph)
        version = graph.version
        restart(place, pair)
        assert graph.wait_for(lambda: graph.version > version and seen(graph) == before, PATIENCE_S)
    assert len(held) == 3


def seen(graph: Graph) -> list[bytes]:
    return [one.gid for node in graph.nodes() for one in graph.endpoints_of(node)]
