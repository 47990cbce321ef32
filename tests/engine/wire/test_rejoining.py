"""Documents that were connected are connected again by themselves, and no others."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.engine.live.display_file import FOLDER
from studio.engine.messages import live as v
from studio.engine.messages.wire import ConnectWire, DisconnectWire
from studio.engine.wire.desk import WireDesk
from studio.engine.wire.rejoining import Rejoining, place_of
from studio.settings import WireChoice
from tests.support.open_documents import until
from tests.support.wire import free_endpoint
from tests.support.wired_studio import Studio, studio

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network


def state(one: Studio) -> str:
    return one.ear.last("wire_state")["state"]


def reasons(one: Studio) -> list[str]:
    told = [event for event in one.ear.events if event["type"] == "display_states"]
    return [remark["reason"] for each in told[-1:] for remark in each["states"][0]["remarks"]]


async def kept(folder: Path, *, connected: bool) -> None:
    """Wait until the file says whether it was connected."""

    def says() -> bool:
        written = list((folder / "data" / FOLDER).glob("[!.]*.json"))
        return any((b"connected_to" in one.read_bytes()) == connected for one in written)

    await until(says)


async def with_a_path(endpoint: str, folder: Path, *, disconnects: bool) -> None:
    """A display is added, which connects, and the studio is closed."""
    async with studio(endpoint, folder) as one:
        await one.do(v.AddDisplay(kind="Path", topic="/plan"))
        await kept(folder, connected=True)
        if disconnects:
            await one.do(DisconnectWire())
            await kept(folder, connected=False)


def test_a_document_that_was_connected_is_connected_again(endpoint: str, tmp_path: Path):
    async def run() -> None:
        await with_a_path(endpoint, tmp_path, disconnects=False)
        async with studio(endpoint, tmp_path) as one:
            await until(lambda: state(one) == "connected")
            await until(lambda: reasons(one) == ["no_publisher"])

    asyncio.run(run())


def test_one_that_was_disconnected_stays_so_and_says_what_mends_it(endpoint: str, tmp_path: Path):
    async def run() -> None:
        await with_a_path(endpoint, tmp_path, disconnects=True)
        async with studio(endpoint, tmp_path) as one:
            await until(lambda: reasons(one) == ["not_connected"])
            assert state(one) == "off"
            mend = one.ear.last("display_states")["states"][0]["remarks"][0]["mend"]
            assert mend["command"] == {"type": "connect_wire"}
            await one.do(ConnectWire())
            await until(lambda: reasons(one) == ["no_publisher"])

    asyncio.run(run())


@pytest.mark.parametrize("router", ["auto", "off"])
def test_where_no_router_answers_none_is_started(router: str):
    async def run() -> None:
        wire = WireDesk(WireChoice(router, (free_endpoint(),)))
        place, rejoining = place_of(wire.choice), Rejoining(wire)
        await rejoining.rejoin(place)
        assert wire.current is None
        assert rejoining.place == place, "it is looked for the next time, too"
        await wire.close()

    asyncio.run(run())


@pytest.mark.parametrize("place", ["", "tcp/127.0.0.1:7447 domain 0"])
def test_who_was_connected_elsewhere_or_not_at_all_is_not_connected(endpoint: str, place: str):
    async def run() -> None:
        wire = WireDesk(WireChoice("off", (endpoint,)))
        await Rejoining(wire).rejoin(place)
        assert wire.current is None
        await wire.close()

    asyncio.run(run())


def test_an_endpoint_that_is_none_is_not_asked():
    async def run() -> None:
        wire = WireDesk(WireChoice("auto", ("nonsense",)))
        await Rejoining(wire).rejoin(place_of(wire.choice))
        assert wire.current is None
        await wire.close()

    asyncio.run(run())
