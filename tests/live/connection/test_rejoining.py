"""A studio that was connected is connected again by itself after a restart, and no other."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import msgspec
import pytest

from studio.live.connection.rejoining import FILE, KeptConnection, Rejoining, place_of
from studio.live.connection.ros_connection import RosConnection
from studio.protocol.connection import ConnectWire, DisconnectWire
from studio.protocol.displays import AddDisplay
from studio.settings import WireChoice
from tests.support.open_documents import until
from tests.support.wire import free_endpoint, router_at
from tests.support.wired_studio import Studio, studio

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

pytestmark = pytest.mark.network


def state(one: Studio) -> str:
    return one.ear.last("wire_state")["state"]


def reasons(one: Studio) -> list[str]:
    told = [event for event in one.ear.events if event["type"] == "display_states"]
    return [remark["reason"] for each in told[-1:] for remark in each["states"][0]["remarks"]]


def kept(data_folder: Path) -> KeptConnection:
    file = data_folder / FILE
    if not file.exists() or not file.read_bytes():
        return KeptConnection()
    return msgspec.json.decode(file.read_bytes(), type=KeptConnection)


def keep(data_folder: Path, connection: KeptConnection) -> None:
    (data_folder / FILE).write_bytes(msgspec.json.encode(connection))


def test_a_studio_that_was_connected_is_connected_again(endpoint: str, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(ConnectWire())
        async with studio(endpoint, tmp_path) as one:
            await until(lambda: state(one) == "connected")

    asyncio.run(run())


def test_its_displays_listen_again(endpoint: str, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Path", topic="/plan"))
        async with studio(endpoint, tmp_path) as one:
            await until(lambda: reasons(one) == ["no_publisher"])

    asyncio.run(run())


def test_one_that_was_disconnected_stays_so_and_says_what_mends_it(endpoint: str, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(AddDisplay(kind="Path", topic="/plan"))
            await one.do(DisconnectWire())
        async with studio(endpoint, tmp_path) as one:
            await until(lambda: reasons(one) == ["not_connected"])
            assert state(one) == "off"
            mend = one.ear.last("display_states")["states"][0]["remarks"][0]["mend"]
            assert mend["command"] == {"type": "connect_wire"}
            await one.do(ConnectWire())
            await until(lambda: reasons(one) == ["no_publisher"])

    asyncio.run(run())


def test_a_router_that_comes_later_than_the_studio_is_waited_for(tmp_path: Path):
    async def run() -> None:
        endpoint = free_endpoint()
        wire = RosConnection(WireChoice("off", (endpoint,)))
        keep(tmp_path, KeptConnection(place_of(wire.choice), (endpoint,)))
        rejoining = Rejoining(wire, tmp_path)
        rejoining.begin()
        with router_at(endpoint):
            await until(lambda: wire.current is not None)
            await rejoining.close()
            await wire.close()

    asyncio.run(run())


def test_a_router_of_its_own_is_started_again(tmp_path: Path):
    async def run() -> None:
        wire = RosConnection(WireChoice("auto", (free_endpoint(),)))
        keep(
            tmp_path,
            KeptConnection(place_of(wire.choice), wire.choice.connect, had_own_router=True),
        )
        rejoining = Rejoining(wire, tmp_path)
        rejoining.begin()
        await until(lambda: wire.current is not None)
        assert wire.current is not None
        assert wire.current.has_own_router
        await rejoining.close()
        await wire.close()

    asyncio.run(run())


def test_where_a_person_had_it_look_is_where_it_looks_again(endpoint: str, tmp_path: Path):
    async def run() -> None:
        wire = RosConnection(WireChoice("off", (free_endpoint(),)))
        keep(tmp_path, KeptConnection(place_of(wire.choice), (endpoint,), domain=3))
        rejoining = Rejoining(wire, tmp_path)
        rejoining.begin()
        await until(lambda: wire.current is not None)
        assert wire.choice == WireChoice("off", (endpoint,), 3)
        await rejoining.close()
        await wire.close()

    asyncio.run(run())


def begun(wire: RosConnection, data_folder: Path) -> Callable[[], bool]:
    """Tells whether it gave up by itself."""
    rejoining = Rejoining(wire, data_folder)
    rejoining.begin()
    (task,) = [one for one in asyncio.all_tasks() if one is not asyncio.current_task()]
    return task.done


@pytest.mark.parametrize("place", ["", "tcp/127.0.0.1:7447 domain 0"])
def test_who_was_connected_elsewhere_or_not_at_all_is_not_connected(
    endpoint: str, tmp_path: Path, place: str
):
    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        keep(tmp_path, KeptConnection(place, (endpoint,)))
        await until(begun(wire, tmp_path))
        assert wire.current is None
        await wire.close()

    asyncio.run(run())


@pytest.mark.parametrize("text", [b"", b"{", b"[]", b'{"connect": 3}', b"\xff"])
def test_a_broken_file_is_as_none(endpoint: str, tmp_path: Path, text: bytes):
    async def run() -> None:
        (tmp_path / FILE).write_bytes(text)
        wire = RosConnection(WireChoice("off", (endpoint,)))
        await until(begun(wire, tmp_path))
        assert wire.current is None
        await wire.close()

    asyncio.run(run())


def test_who_disconnects_is_not_connected_again(endpoint: str, tmp_path: Path):
    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        rejoining = Rejoining(wire, tmp_path)
        await wire.link()
        await until(lambda: kept(tmp_path).connect == (endpoint,))
        await wire.disconnect()
        await rejoining.close()
        assert kept(tmp_path) == KeptConnection()
        await wire.close()

    asyncio.run(run())
