"""A bridge at a router, and a page's ear that follows what is done there."""

from __future__ import annotations

from contextlib import asynccontextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, cast, get_args

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.ros_system import RosSystem
from studio.protocol.calls import FollowOperations
from studio.settings import WireChoice
from tests.support.asked import ask_ros
from tests.support.open_documents import Ear, until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.protocol import Command


class Bridged:
    """Does what a page asks, and knows how all operations fare, as a page does."""

    def __init__(self, ros: RosSystem, ear: Ear) -> None:
        self.ros, self.ear = ros, ear

    async def do(self, command: Command) -> Any:  # noqa: ANN401 - the answer
        """Ask, and give the answer."""
        return await ask_ros(self.ros, command, self.ear)

    def operation(self, kind: str, number: int) -> dict[str, Any]:
        """An operation as it was told last; empty before."""
        told = (one for one in self.ear.events if one["type"] == kind)
        found = [
            operation
            for one in told
            for operation in one["operations"]
            if operation["operation"] == number
        ]
        return found[-1] if found else {}

    async def operation_in(self, kind: str, number: int, *states: str) -> dict[str, Any]:
        """Wait until an operation is told to be in one of some states."""
        await until(lambda: self.operation(kind, number).get("state") in states)
        return self.operation(kind, number)

    async def begin(self, command: Command) -> int:
        """Begin an operation; gives its number."""
        return cast("int", (await self.do(command)).operation)


@asynccontextmanager
async def bridged(endpoint: str) -> AsyncGenerator[Bridged]:
    """A bridge that has joined the router; its ear follows calls, goals and publications."""
    with TemporaryDirectory() as folder:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        ros, ear = RosSystem(wire, Path(folder) / "bags"), Ear()
        try:
            await wire.link()
            for kind in get_args(FollowOperations.model_fields["operations"].annotation):
                await ask_ros(ros, FollowOperations(operations=kind), ear)
            yield Bridged(ros, ear)
        finally:
            await ros.close()
            await wire.close()
