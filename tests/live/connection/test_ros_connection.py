"""The connection of the studio: made when first used, told to every page, and back by itself."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.errors import ForeignEndpointError, NoRouterError
from studio.live.connection.ros_connection import RosConnection
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.open_documents import Ear, until
from tests.support.wire import free_endpoint, router_at, running_router

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

pytestmark = pytest.mark.network


@asynccontextmanager
async def connection(choice: WireChoice) -> AsyncGenerator[tuple[RosConnection, Ear]]:
    made, ear = RosConnection(choice), Ear()
    made.attach(ear)
    try:
        yield made, ear
    finally:
        await made.close()


def state(ear: Ear) -> str:
    return ear.last("wire_state")["state"]


def test_an_engine_that_nobody_asks_for_ros_does_not_import_zenoh():
    code = (
        "import sys, studio.documents.engine, studio.server.launch;"
        "print([one for one in ('zenoh', 'rosbags') if one in sys.modules])"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "[]"


def test_it_joins_the_router_that_is_there_once_for_all_who_ask():
    async def run() -> None:
        with running_router() as endpoint:
            async with connection(WireChoice(connect=(endpoint,), domain=3)) as (made, ear):
                assert ear.last("wire_state") == ear.events[0]
                assert (state(ear), ear.events[0]["endpoint"]) == ("off", endpoint)
                first, second = await asyncio.gather(made.link(), made.link())
                assert first is second
                told = ear.last("wire_state")
                assert (told["state"], told["router"], told["domain"]) == ("connected", "joined", 3)
                assert [one["state"] for one in ear.events] == ["off", "connecting", "connected"]

    asyncio.run(run())


def test_where_no_router_answers_it_starts_its_own_and_takes_it_away_again():
    endpoint = free_endpoint()

    async def run() -> None:
        async with connection(WireChoice(connect=(endpoint,))) as (made, ear):
            await made.link()
            assert ear.last("wire_state")["router"] == "own"
        router_at(endpoint).close()  # the place is free again

    asyncio.run(run())


def test_without_a_router_it_says_why_and_tries_again_when_asked_again():
    endpoint = free_endpoint()

    async def run() -> None:
        async with connection(WireChoice("off", (endpoint,))) as (made, ear):
            with pytest.raises(NoRouterError):
                await made.link()
            assert state(ear) == "failed"
            assert "No Zenoh router answers" in ear.last("wire_state")["trouble"]
            with router_at(endpoint):
                await made.link()
                assert state(ear) == "connected"
                assert ear.last("wire_state")["trouble"] == ""

    asyncio.run(run())


def test_an_endpoint_that_something_else_holds_is_said():
    async def run() -> None:
        async def answer(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            writer.write(b"HTTP/1.1 400 Bad Request\r\n\r\n")
            writer.close()

        async with await asyncio.start_server(answer, "127.0.0.1", 0) as server:
            port = server.sockets[0].getsockname()[1]
            choice = WireChoice(connect=(f"tcp/127.0.0.1:{port}",))
            async with connection(choice) as (made, ear):
                with pytest.raises(ForeignEndpointError):
                    await made.link()
                assert state(ear) == "failed"

    asyncio.run(run())


def test_a_fault_of_ours_leaves_no_connection_being_made(monkeypatch: pytest.MonkeyPatch):
    def break_down(*_: object) -> None:
        raise RuntimeError("a bug")

    async def run() -> None:
        monkeypatch.setattr("studio.live.connection.link.open_wire", break_down)
        async with connection(WireChoice(connect=(free_endpoint(),))) as (made, ear):
            with pytest.raises(RuntimeError):
                await made.link()
            assert state(ear) == "failed"

    asyncio.run(run())


def test_an_environment_that_cannot_be_is_said_before_anybody_asks(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "many")

    async def run() -> None:
        async with connection(WireChoice()) as (_, ear):
            assert "ROS_DOMAIN_ID is 'many'" in ear.last("wire_state")["trouble"]

    asyncio.run(run())


def test_nodes_that_come_and_go_are_told_and_our_own_are_not():
    async def run() -> None:
        with running_router() as endpoint:
            async with connection(WireChoice(connect=(endpoint,))) as (made, ear):
                await made.link()
                with node_at(endpoint, "somebody"):
                    await until(lambda: ear.last("wire_state")["nodes"] == ["/somebody"])
                await until(lambda: ear.last("wire_state")["node_count"] == 0)

    asyncio.run(run())


def test_a_router_that_goes_away_is_said_and_all_is_back_when_it_is():
    async def run() -> None:
        router = router_at(free_endpoint())
        endpoint = router.endpoint.text
        try:
            async with connection(WireChoice("off", (endpoint,))) as (made, ear):
                await made.link()
                router.close()
                await until(lambda: state(ear) == "lost")
                router = router_at(endpoint)
                await until(lambda: state(ear) == "connected")
                with node_at(endpoint, "somebody"):
                    await until(lambda: ear.last("wire_state")["nodes"] == ["/somebody"])
        finally:
            router.close()

    asyncio.run(run())
