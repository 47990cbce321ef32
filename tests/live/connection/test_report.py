"""What there is at a place on the wire, for each reason why nobody may be seen (row Q1)."""

from __future__ import annotations

import asyncio
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.nearby import nodes_nearby
from studio.live.connection.report import Census, examine, seen_distros
from studio.live.connection.ros_connection import RosConnection
from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes
from studio.ros.profiles import JAZZY
from studio.ros.tokens import EndpointKind
from studio.ros.types.library import TypeLibrary
from studio.settings import WireChoice
from tests.support.dds_bridge import DdsNetwork
from tests.support.dds_bridges import bridge, bridged_end, started
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


def test_nodes_on_dds_count_and_ends_that_tell_no_hash_are_of_humble():
    hashes = DistroHashes(TypeLibrary("jazzy"))
    census = Census()
    census.take_bridges((bridge("/talker", ends=(bridged_end("/chatter"),)),), DOMAIN)
    assert census.nodes == {0: 1}
    assert seen_distros(census.endpoints.values(), hashes) == ("humble",)
    assert foreign_hashes(census.endpoints.values(), JAZZY, hashes) == []


def test_services_and_actions_on_dds_say_nothing_of_a_distribution():
    service = bridged_end("/add", kind=EndpointKind.SERVICE, type_name="a/srv/Add")
    status = bridged_end("/turn/_action/status", type_name="action_msgs/msg/GoalStatusArray")
    census = Census()
    census.take_bridges((bridge("/talker", ends=(service, status)),), DOMAIN)
    assert not census.endpoints


def test_nodes_behind_a_bridge_of_another_domain_count_there():
    census = Census()
    other = bridge("/a", "/b", settings=started(5), is_used=False, ends=(bridged_end("/chatter"),))
    census.take_bridges((other,), DOMAIN)
    assert (census.nodes, census.endpoints) == ({5: 2}, {})


@pytest.fixture(scope="module")
def network() -> Generator[DdsNetwork]:
    with DdsNetwork() as made:
        yield made


def test_a_robot_on_dds_is_fine_and_counted_before_the_studio_connects(network: DdsNetwork):
    shown = network.bridge(config={"deny": {"publishers": ["/odom", "/scan"]}})
    robot = network.robot("classroom")
    told = seen(at(shown.endpoint, 0), "fine")
    wait_until("all", lambda: examine(at(shown.endpoint, 0), ()).bridges[0].withheld_count == 2)
    (view,) = examine(at(shown.endpoint, 0), ()).bridges
    assert (view.state, view.withheld, view.allows) == ("used", ("/odom", "/scan"), False)
    assert "jazzy" in told.distros
    assert nodes_nearby(at(shown.endpoint, 0)) == view.node_count > 1
    told = seen(at(shown.endpoint, 3), "other_domain")
    assert [one.domain for one in told.domains] == [0]
    assert told.bridges[0].state == "other_domain"
    for one in (robot, shown):
        one.end()


def test_a_bridge_behind_which_no_node_is_seen_is_told_as_such(network: DdsNetwork):
    shown = network.bridge(domain=9, options=("--ros-localhost-only",))
    told = seen(at(shown.endpoint, 9), "bridge")
    (view,) = told.bridges
    assert (told.nodes, view.state, view.domain, view.localhost_only) == (0, "empty", 9, True)
    assert view.version.startswith("1.")
    shown.end()


def test_nodes_of_humble_on_dds_are_fine_and_said_to_be_of_humble(network: DdsNetwork):
    shown, robot = (
        network.bridge(domain=4, distro="humble"),
        network.robot("classroom", distro="humble", domain=4),
    )
    told = seen(at(shown.endpoint, 4), "fine")
    wait_until("its types", lambda: examine(at(shown.endpoint, 4), ()).distros == ("humble",))
    assert told.types == ()
    for one in (robot, shown):
        one.end()


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
