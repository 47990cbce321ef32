from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import StudioError
from studio.protocol.publishing import Publish, StopPublishing
from studio.protocol.roles import Role
from tests.support.bridged import bridged
from tests.support.demos import heard
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from studio.ros.client import Node

pytestmark = pytest.mark.network
STRING = "std_msgs/msg/String"
STAMPED = "geometry_msgs/msg/PointStamped"


def say(text: str = "{data: hello}", *, kind: str = STRING, **options: object) -> Publish:
    return Publish.model_validate({"name": "/said", "message_type": kind, "text": text, **options})


def test_what_goes_on_and_on_ends_with_the_last_page_that_could_stop_it(
    endpoint: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("studio.live.panels.publishing._GRACE_S", 0.05)

    async def run() -> None:
        async with bridged(endpoint) as page:
            first, second, viewer = Ear(), Ear(), Ear(Role.GUEST)
            for one in (first, second, viewer):
                page.ros.attach(one)
            number = await page.begin(say(rate_hz=20))
            page.ros.detach(first)
            await until(lambda: page.operation("publications", number).get("sent", 0) > 4)
            assert page.operation("publications", number)["state"] == "running"
            page.ros.detach(second)
            told = await page.operation_in("publications", number, "failed", "stopped")
            assert told["trouble"] == "The last page that could stop it was closed."

    asyncio.run(run())


def test_a_page_that_is_loaded_anew_stops_nothing(endpoint: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("studio.live.panels.publishing._GRACE_S", 0.05)

    async def run() -> None:
        async with bridged(endpoint) as page:
            before, after = Ear(), Ear()
            page.ros.attach(before)
            number = await page.begin(say(rate_hz=50))
            page.ros.detach(before)
            page.ros.attach(after)
            sent = page.ros.publishing.operations.get(number).sent
            await until(lambda: page.operation("publications", number).get("sent", 0) > sent + 20)
            assert page.operation("publications", number)["state"] == "running"
            await page.do(StopPublishing())
            await page.operation_in("publications", number, "stopped")

    asyncio.run(run())


def test_now_is_the_time_of_each_message(endpoint: str, tester: Node):
    points = heard(tester, STAMPED, "/said")

    async def run() -> None:
        async with bridged(endpoint) as page:
            ask = say("{header: auto, point: {x: 1.0}}", kind=STAMPED, rate_hz=50)
            number = await page.begin(ask)
            await until(lambda: len(points) > 3)
            await page.do(StopPublishing(operation=number))
            await page.operation_in("publications", number, "stopped")

    asyncio.run(run())
    stamps = [one.header.stamp.sec * 10**9 + one.header.stamp.nanosec for one in points]
    assert stamps == sorted(set(stamps))
    assert stamps[0] > 10**18


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (say("{nothing: 1}"), "no field 'nothing'"),
        (say(kind="nowhere_at/msg/All"), "cannot be used"),
        (say(kind="what"), "what"),
        (say(name="/sa id"), "sa id"),
    ],
)
def test_what_cannot_be_published_is_refused(endpoint: str, ask: Publish, words: str):
    async def run() -> None:
        async with bridged(endpoint) as page:
            with pytest.raises(StudioError, match=words):
                await page.do(ask)
            with pytest.raises(StudioError, match="number 7"):
                await page.do(StopPublishing(operation=7))

    asyncio.run(run())


def test_its_quality_of_service_is_what_was_asked_for(endpoint: str, tester: Node):
    async def run() -> None:
        async with bridged(endpoint) as page:
            await page.begin(say(rate_hz=1, latched=True, reliable=False, depth=3))
            await until(lambda: bool(tester.graph.publishers("/said")))
            qos = tester.graph.publishers("/said")[0].qos
            assert (qos.durability.name, qos.reliability.name) == (
                "TRANSIENT_LOCAL",
                "BEST_EFFORT",
            )
            assert qos.depth == 3

    asyncio.run(run())
