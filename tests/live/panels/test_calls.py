from __future__ import annotations

import asyncio
import json
import threading
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import StudioError
from studio.protocol.calls import CallService, CancelCall, GetServices
from tests.support.bridged import Bridged, bridged
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Node
    from studio.ros.node.service import Service

pytestmark = pytest.mark.network
ADD = "example_interfaces/srv/AddTwoInts"


def add(request: Any, response: Any) -> Any:  # noqa: ANN401
    response.sum = request.a + request.b
    return response


@pytest.fixture
def adder(tester: Node) -> Service:
    return tester.create_service(tester.wire.types.service(ADD), "/add", add)


@pytest.fixture
def slow(tester: Node) -> Generator[threading.Event]:
    """A service that answers when the test is over."""
    go_on = threading.Event()

    def wait(request: Any, response: Any) -> Any:  # noqa: ANN401
        go_on.wait()
        return add(request, response)

    tester.create_service(tester.wire.types.service(ADD), "/slow", wait)
    yield go_on
    go_on.set()


def call(name: str, text: str = "{a: 41, b: 1}", **options: Any) -> CallService:  # noqa: ANN401
    return CallService(name=name, service_type=ADD, text=text, **options)


async def served(page: Bridged, name: str) -> None:
    while name not in [one.name for one in (await page.do(GetServices())).services]:  # noqa: ASYNC110
        await asyncio.sleep(0.01)


def test_a_call_is_answered_and_its_reply_and_time_are_told(endpoint: str, adder: Service):
    async def run() -> None:
        async with bridged(endpoint) as page:
            await served(page, adder.srv_name)
            number = await page.begin(call("add"))
            told = await page.operation_in("calls", number, "answered", "failed")
            assert (told["state"], json.loads(told["reply"])) == ("answered", {"sum": 42})
            assert (told["name"], told["service_type"]) == ("/add", ADD)
            assert told["text"] == "{a: 41, b: 1}"
            assert 0 < told["took_s"] < 60

    asyncio.run(run())


def test_who_follows_later_is_told_of_the_calls_of_before(endpoint: str, adder: Service):
    async def run() -> None:
        async with bridged(endpoint) as page:
            number = await page.begin(call(adder.srv_name))
            await page.operation_in("calls", number, "answered")
            newcomer = Ear()
            page.ros.calls.operations.follow(newcomer)
            (event,) = newcomer.events
            assert (event["whole"], [one["operation"] for one in event["operations"]]) == (
                True,
                [number],
            )

    asyncio.run(run())


@pytest.mark.parametrize(
    ("name", "kind", "text", "words"),
    [
        ("/add", ADD, "{c: 1}", "no field 'c'"),
        ("/add", ADD, "{a: [", "no YAML"),
        ("/add", "nowhere_at/srv/All", "", "cannot be used"),
        ("/ad d", ADD, "", "ad d"),
    ],
)
def test_what_cannot_be_asked_is_refused_and_not_begun(
    endpoint: str, name: str, kind: str, text: str, words: str
):
    async def run() -> None:
        async with bridged(endpoint) as page:
            with pytest.raises(StudioError, match=words):
                await page.do(CallService(name=name, service_type=kind, text=text))
            assert page.ros.calls.operations.unfinished() == []

    asyncio.run(run())


@pytest.mark.usefixtures("slow")
@pytest.mark.parametrize(
    ("name", "timeout_s", "words"),
    [
        ("/nobody", 0.2, "No node serves the service /nobody"),
        ("/slow", 0.5, "gave no answer within 0.5 s"),
    ],
)
def test_nobody_and_who_is_silent_are_given_up_in_time(
    endpoint: str, name: str, timeout_s: float, words: str
):
    async def run() -> None:
        async with bridged(endpoint) as page:
            number = await page.begin(call(name, timeout_s=timeout_s))
            assert words in (await page.operation_in("calls", number, "failed"))["trouble"]

    asyncio.run(run())


@pytest.mark.usefixtures("slow")
def test_who_serves_it_with_another_type_is_said_to(endpoint: str):
    other = CallService(name="/slow", service_type="std_srvs/srv/Empty", timeout_s=0.2)

    async def run() -> str:
        async with bridged(endpoint) as page:
            await served(page, "/slow")
            number = await page.begin(other)
            return (await page.operation_in("calls", number, "failed"))["trouble"]

    trouble = asyncio.run(run())
    assert trouble.startswith(f"The service /slow is served as {ADD}, ")
    assert trouble.endswith("not as std_srvs/srv/Empty: call it with that type.")


@pytest.mark.usefixtures("slow")
def test_a_call_is_cancelled_at_once(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            waiting = await page.begin(call("/slow", timeout_s=600))
            await page.do(CancelCall(operation=waiting))
            told = await page.operation_in("calls", waiting, "cancelled", "failed")
            assert (told["state"], told["trouble"]) == ("cancelled", "")
            with pytest.raises(StudioError, match="number 99"):
                await page.do(CancelCall(operation=99))
            await page.do(CancelCall(operation=waiting))  # again is harmless

    asyncio.run(run())


@pytest.mark.usefixtures("slow")
def test_what_runs_ends_with_the_connection_and_says_so(endpoint: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            number = await page.begin(call("/slow", timeout_s=600))
            await page.ros.let_go()
            await until(lambda: page.operation("calls", number).get("state") == "failed")
            assert "connection with ROS 2 was ended" in page.operation("calls", number)["trouble"]

    asyncio.run(run())
