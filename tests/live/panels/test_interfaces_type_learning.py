"""Types that only other nodes know are told to pages like all others."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.errors import UnknownTypeError
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.interfaces import InterfaceTypes
from studio.protocol.interfaces import GetInterface
from studio.ros.types.library import TypeLibrary
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.open_documents import until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.live.connection.link import WireLink

pytestmark = pytest.mark.network
WHOLE, ASK = "odd_msgs/msg/Whole", "odd_msgs/srv/Ask"
VECTOR, STAMPED = "geometry_msgs/msg/Vector3", "geometry_msgs/msg/Vector3Stamped"
TEXTS = {
    "odd_msgs/msg/Part": "string name\n",
    WHOLE: "# All of it.\n\nPart[] parts\n",
    ASK: "string question\n---\nPart part\n",
}


def foreign_types() -> TypeLibrary:
    made = TypeLibrary("jazzy")
    made.add_texts(TEXTS)
    return made


@asynccontextmanager
async def joined(endpoint: str) -> AsyncGenerator[tuple[InterfaceTypes, WireLink]]:
    wire = RosConnection(WireChoice("off", (endpoint,)))
    try:
        link = await wire.link()
        yield InterfaceTypes(wire), link
    finally:
        await wire.close()


@pytest.mark.usefixtures("library")
def test_a_type_that_a_node_tells_is_known_with_its_parts_and_comments(endpoint: str):
    types = foreign_types()

    async def run() -> None:
        with node_at(endpoint, "odd_one", types) as odd:
            odd.create_publisher(types.message(WHOLE), "/whole", 10)
            odd.create_service(types.service(ASK), "/ask", lambda _, reply: reply)
            async with joined(endpoint) as (known, link):
                await until(lambda: bool(link.graph.servers("/ask")))
                await until(lambda: bool(link.graph.publishers("/whole")))
                asked = [known.interface(GetInterface(name=name)) for name in (WHOLE, ASK, WHOLE)]
                told = await asyncio.gather(*asked)
        assert [one.hash for one in told] == [types.hash_of(one.name) for one in told]
        whole = told[0].messages[0]
        assert (whole.comment, whole.fields[0].base) == ("All of it.", "odd_msgs/msg/Part")

    asyncio.run(run())


@pytest.mark.usefixtures("library")
def test_comments_of_a_type_that_all_know_are_asked_of_a_node_that_has_its_text(endpoint: str):
    types = TypeLibrary("jazzy")
    types.add_texts({VECTOR: "# Where it is.\n\nfloat64 x # ahead\nfloat64 y\nfloat64 z\n"})

    async def run() -> None:
        with node_at(endpoint, "odd_one", types) as odd:
            odd.create_publisher(types.message(STAMPED), "/at", 10)
            async with joined(endpoint) as (known, link):
                await until(lambda: bool(link.graph.publishers("/at")))
                plain = await known.interface(GetInterface(name=STAMPED))
                told = await known.interface(GetInterface(name=STAMPED, with_text=True))
                vector = await known.interface(GetInterface(name=VECTOR))
        assert (plain.text, told.hash) == ("", plain.hash)
        by_name = {one.name: one for one in told.messages}
        assert by_name[VECTOR].comment == "Where it is."
        assert vector.messages[0].fields[0].comment == "ahead"
        assert "float64 x # ahead" in vector.text

    asyncio.run(run())


@pytest.mark.usefixtures("library")
def test_a_type_that_nobody_tells_is_refused_with_what_to_do(endpoint: str):
    async def run() -> None:
        async with joined(endpoint) as (known, _):
            for _ in range(2):
                with pytest.raises(
                    UnknownTypeError, match=r"node describes it; drop its \.srv file"
                ):
                    await known.interface(GetInterface(name=ASK))

    asyncio.run(run())
