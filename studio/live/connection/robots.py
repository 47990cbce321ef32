"""Commands about ROS that concern no document yet: join, leave, report, open a robot."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import CommandError
from studio.live.connection.plan import chosen_wire
from studio.live.connection.received_description import receive_description
from studio.packages.received_texts import choose_packages, keep_description
from studio.protocol.commands import Commands, Scope
from studio.protocol.connection import (
    ConnectWire,
    DisconnectWire,
    ExamineWire,
    FindWireRobots,
    OpenFromWire,
    WireReport,
    WireRobots,
)
from studio.protocol.documents import Opened

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.live.connection.feed import RobotFeed
    from studio.live.connection.received_description import ReceivedDescription
    from studio.live.connection.ros_connection import RosConnection
    from studio.packages.index import PackageIndex
    from studio.packages.roots import ServedRoots
    from studio.packages.workspace import Location

_FIRST_PATIENCE_S = 5.0
"""A latched description comes at once, or there is none."""


class LetsGo(Protocol):
    """A user of the connection that can be detached from it."""

    async def let_go(self) -> None:
        """Let go of the connection, which is about to end."""
        ...


class OpenRobot(Protocol):
    """An open document."""

    @property
    def location(self) -> Location:
        """The folders of its files."""
        ...

    @property
    def feed(self) -> RobotFeed:
        """Connects its robot with ROS."""
        ...


class OpenRobots(Protocol):
    """All open documents."""

    @property
    def documents(self) -> Mapping[str, OpenRobot]:
        """The open documents by id."""
        ...

    async def open_at(
        self, path: Path, arguments: Mapping[str, str], within: ServedRoots | None
    ) -> str:
        """Open a path, serve its folders from now on, and return the document's id.

        Raises:
            StudioError: Nothing there can be opened.
        """
        ...


class ConnectionCommands:
    """Carries them out; `ros` lets go of a connection before it ends."""

    def __init__(
        self, wire: RosConnection, data_folder: Path, opener: OpenRobots, ros: LetsGo
    ) -> None:
        self._wire, self._data_folder, self._opener = wire, data_folder, opener
        self._ros = ros

    async def connect(self, command: ConnectWire) -> None:
        """Join the ROS system, or another one.

        Raises:
            StudioError: There is no router, or it cannot be reached.
        """
        chosen = chosen_wire(self._wire.choice, command)
        if chosen != self._wire.choice:
            # First, so that a connection asked for meanwhile is the new one.
            self._wire.choose(chosen)
            await self.disconnect()
        await self._wire.link()

    async def examine(self, command: ExamineWire) -> WireReport:
        """Return a report on a router."""
        return await asyncio.to_thread(self._examine, command)

    async def find(self, command: FindWireRobots) -> WireRobots:
        """Return the places that describe a robot: topics, and parameters of nodes."""
        link = await self._wire.link()
        topics, nodes = await asyncio.to_thread(link.find_robots)
        return WireRobots(request=command.request, topics=topics, nodes=nodes)

    def _examine(self, command: ExamineWire) -> WireReport:
        from studio.live.connection.report import examine  # noqa: PLC0415 - imports zenoh

        link = self._wire.current
        own = () if link is None else (link.zid,)
        return examine(chosen_wire(self._wire.choice, command), own, command.request)

    async def disconnect(self) -> None:
        """Leave the ROS system; all that goes out or comes in for a document ends before."""
        await self._let_go()
        await self._wire.disconnect()
        await self._let_go()  # of what was switched on with it meanwhile

    async def _let_go(self) -> None:
        documents = self._opener.documents.values()
        parts: list[LetsGo] = [one.feed for one in documents]
        await asyncio.gather(*(part.let_go() for part in (*parts, self._ros)))

    async def open(self, command: OpenFromWire) -> Opened:
        """Open a robot that is described there, and let its joints follow.

        Raises:
            StudioError: It is not described, or cannot be opened.
        """
        link = await self._wire.link()
        description = await asyncio.to_thread(receive_description, self._wire.topics, link, command)
        try:
            name = await self._open_first(description)
        except BaseException:
            description.close()
            raise
        feed = self._opener.documents[name].feed
        await feed.describe(description, self._data_folder)
        await feed.choose("joint_states")
        return Opened(request=command.request, document=name)

    async def _open_first(self, description: ReceivedDescription) -> str:
        text = await asyncio.to_thread(description.first, _FIRST_PATIENCE_S)
        if text is None:
            raise CommandError(
                f"No description came from {description.source} within {_FIRST_PATIENCE_S:.0f} s: "
                "is robot_state_publisher running, in this domain?"
            )
        indexes = [one.location.index for one in self._opener.documents.values()]
        keep = partial(_keep, self._data_folder, description.source, text, indexes)
        return await self._opener.open_at(await asyncio.to_thread(keep), {}, None)


def _keep(data_folder: Path, source: str, text: str, indexes: list[PackageIndex]) -> Path:
    file = keep_description(data_folder, source, text)
    choose_packages(data_folder, file, text, indexes)
    return file


COMMANDS: Final = Commands[ConnectionCommands](Scope.ROS)
COMMANDS.presenter(ConnectWire, lambda robots, c, _: robots.connect(c))
COMMANDS.presenter(ExamineWire, lambda robots, c, _: robots.examine(c))
COMMANDS.presenter(DisconnectWire, lambda robots, _, __: robots.disconnect())
COMMANDS.presenter(FindWireRobots, lambda robots, c, _: robots.find(c))
COMMANDS.presenter(OpenFromWire, lambda robots, c, _: robots.open(c))
