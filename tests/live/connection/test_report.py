"""What there is at a place on the wire, for each reason why nobody may be seen (row Q1)."""

from __future__ import annotations

import asyncio
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.report import Census, examine
from studio.live.connection.ros_connection import RosConnection
from studio.ros.wire.zenoh import declare_token
from studio.settings import WireChoice
from tests.support.wire import (
    free_endpoint,
    open_test_session,
    router_at,
    running_router,
    show_endpoints,
    wait_until,
)

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.protocol.connection import WireReport
    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.session import WireSession

pytestmark = pytest.mark.network
DOMAIN = 7


def at(endpoint: str, domain: int = DOMAIN, distro: str = "jazzy") -> WireChoice:
    return WireChoice("auto", (endpoint,), domain, distro)


@contextmanager
def robot(
    endpoint: str, domain: int = DOMAIN, distro: str = "jazzy", types: TypeLibrary | None = None
) -> Generator[WireSession]:
    """A node with a publisher, in a session of its own."""
    with open_test_session(endpoint, domain, distro, types) as wire:
        shown = show_endpoints(wire, 1, "robot")
        yield wire
        del shown


def seen(choice: WireChoice, verdict: str) -> WireReport:
    """What is told as soon as it is this; a router hears of tokens a moment after their making."""
    told: list[WireReport] = []

    def is_it() -> bool:
        told.append(examine(choice, ()))
        return told[-1].verdict == verdict

    wait_until(verdict, is_it)
    return told[-1]


def test_nobody_at_the_address_is_said_and_whether_a_router_would_be_started():
    endpoint = free_endpoint()
    told = examine(at(endpoint), (), 5)
    assert (told.request, told.verdict, told.starts_router) == (5, "no_router", True)
    assert (told.endpoint, told.domain, told.distro) == (endpoint, DOMAIN, "jazzy")
    assert not examine(replace(at(endpoint), router="off"), ()).starts_router
    assert examine(at(endpoint), ()).verdict == "no_router", "looking started none"


def test_something_else_that_holds_the_address_is_said():
    async def run() -> WireReport:
        async def answer(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            writer.write(b"HTTP/1.1 400 Bad Request\r\n\r\n")
            writer.close()
            await writer.wait_closed()

        async with await asyncio.start_server(answer, "127.0.0.1", 0) as server:
            port = server.sockets[0].getsockname()[1]
            return await asyncio.to_thread(examine, at(f"tcp/127.0.0.1:{port}"), ())

    assert asyncio.run(run()).verdict == "foreign"


def test_a_router_without_nodes_is_said():
    with running_router() as endpoint:
        assert examine(at(endpoint), ()).verdict == "alone"


def test_nodes_of_another_domain_are_counted():
    with running_router() as endpoint, robot(endpoint, domain=5), robot(endpoint, domain=5):
        told = seen(at(endpoint), "other_domain")
        wait_until("both", lambda: examine(at(endpoint), ()).domains[0].nodes == 2)
        assert (told.nodes, [one.domain for one in told.domains]) == (0, [5])


def test_nodes_that_can_be_met_are_fine_and_tell_their_distribution():
    with running_router() as endpoint, robot(endpoint):
        told = seen(at(endpoint), "fine")
        assert (told.nodes, told.types) == (1, ())
        assert "jazzy" in told.distros


def test_nodes_of_another_distribution_are_told_with_its_name():
    with running_router() as endpoint, robot(endpoint, distro="humble"):
        told = seen(at(endpoint), "other_distro")
        assert told.distros == ("humble",)
        assert told.types == ("std_msgs/msg/String",)
        assert seen(at(endpoint, distro="humble"), "fine").types == ()


def test_a_bridge_of_dds_alone_is_told():
    with running_router() as endpoint, open_test_session(endpoint, 0) as wire:
        token = f"@/{wire.zid}/@ros2_lv/MP/chatter/std_msgs§msg§String/:1:1:1,10"
        held = declare_token(wire.zenoh, token)
        assert seen(at(endpoint), "bridge").nodes == 0
        held.undeclare()


def test_the_studios_own_nodes_do_not_count():
    async def run() -> None:
        with running_router() as endpoint:
            connection = RosConnection(at(endpoint))
            try:
                link = await connection.link()
                other = await asyncio.to_thread(seen, at(endpoint), "fine")
                assert other.nodes == 1
                own = await asyncio.to_thread(examine, at(endpoint), (link.zid,))
                assert own.verdict == "alone"
            finally:
                await connection.close()

    asyncio.run(run())


def test_a_router_that_ends_leaves_its_address_to_nobody():
    router = router_at(free_endpoint())
    endpoint = router.endpoint.text
    router.close()
    wait_until("its end", lambda: examine(at(endpoint), ()).verdict == "no_router")


@pytest.mark.parametrize("token", ["", "@ros2_lv", "@ros2_lv/x/y", "@ros2_lv/0/" + "a/" * 40])
def test_tokens_that_are_none_do_not_count(token: str):
    census = Census()
    census.take(token, 0, ())
    assert not census.nodes
    assert not census.endpoints
