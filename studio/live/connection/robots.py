"""WireRobots: commands about ROS that concern no document yet: join, leave, look around, open."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import TYPE_CHECKING, Protocol, TypeAlias

from studio import protocol as m
from studio.documents.library import Opener
from studio.errors import CommandError
from studio.live.connection.plan import chosen_wire
from studio.packages.from_wire import choose_packages, keep_description
from studio.protocol.wire import (
    ConnectWire,
    DisconnectWire,
    ExamineWire,
    FindWireRobots,
    OpenFromWire,
    WireReport,
    WireRobots,
)

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.documents.document import Document
    from studio.live.connection.desk import WireDesk
    from studio.live.connection.hearing import DescriptionIn
    from studio.packages.index import PackageIndex

EngineWireCommand: TypeAlias = (
    ConnectWire | ExamineWire | DisconnectWire | FindWireRobots | OpenFromWire
)
_FIRST_PATIENCE_S = 5.0
"""For a description that is latched: it comes at once, or nobody tells one."""


class OpenRobots(Opener, Protocol):
    """What the engine does for it."""

    @property
    def documents(self) -> Mapping[str, Document]:
        """Those that are open, by their ids."""
        ...


class LetsGo(Protocol):
    """Whoever uses the connection, and can do without."""

    async def let_go(self) -> None:
        """Let go of the connection, which is about to end."""
        ...


class WireRobotDesk:
    """Carries them out for the engine; `bridge` lets go of a connection before it ends."""

    def __init__(
        self, wire: WireDesk, data_folder: Path, opener: OpenRobots, bridge: LetsGo
    ) -> None:
        self._wire, self._data_folder, self._opener = wire, data_folder, opener
        self._bridge = bridge

    async def carry_out(self, command: EngineWireCommand) -> m.Event | None:
        """Carry out one command and give its answer, if it has one.

        Raises:
            StudioError: It cannot be done.
        """
        match command:
            case ConnectWire():
                await self._connect(command)
                return None
            case ExamineWire():
                return await asyncio.to_thread(self._examine, command)
            case DisconnectWire():
                await self._disconnect()
                return None
            case FindWireRobots():
                link = await self._wire.link()
                topics, nodes = await asyncio.to_thread(link.find_robots)
                return WireRobots(request=command.request, topics=topics, nodes=nodes)
            case OpenFromWire():
                return m.Opened(request=command.request, document=await self._open(command))

    async def _connect(self, command: ConnectWire) -> None:
        chosen = chosen_wire(self._wire.choice, command)
        if chosen != self._wire.choice:
            # First, so that whoever asks for a connection meanwhile gets the new one.
            self._wire.choose(chosen)
            await self._disconnect()
        await self._wire.link()

    def _examine(self, command: ExamineWire) -> WireReport:
        from studio.live.connection.report import examine  # noqa: PLC0415 - imports zenoh

        link = self._wire.current
        own = () if link is None else (link.zid,)
        return examine(chosen_wire(self._wire.choice, command), own, command.request)

    async def _disconnect(self) -> None:
        await self._let_go()
        await self._wire.disconnect()
        await self._let_go()  # of what was switched on with it meanwhile

    async def _let_go(self) -> None:
        documents = self._opener.documents.values()
        parts: list[LetsGo] = [part for one in documents for part in (one.feed, one.live)]
        await asyncio.gather(*(part.let_go() for part in (*parts, self._bridge)))

    async def _open(self, command: OpenFromWire) -> str:
        link = await self._wire.link()
        description = await asyncio.to_thread(link.hear_description, command)
        try:
            name = await self._open_first(description)
        except BaseException:
            await asyncio.to_thread(description.close)
            raise
        feed = self._opener.document(name).feed
        await feed.describe(description, self._data_folder)
        await feed.choose("joint_states")
        return name

    async def _open_first(self, description: DescriptionIn) -> str:
        text = await asyncio.to_thread(description.first, _FIRST_PATIENCE_S)
        if text is None:
            raise CommandError(
                f"Nothing told a robot at {description.source} within {_FIRST_PATIENCE_S:.0f} s: "
                "is robot_state_publisher running, in this domain?"
            )
        indexes = [one.location.index for one in self._opener.documents.values()]
        keep = partial(_keep, self._data_folder, description.source, text, indexes)
        return await self._opener.open_at(await asyncio.to_thread(keep), {}, None)


def _keep(data_folder: Path, source: str, text: str, indexes: list[PackageIndex]) -> Path:
    file = keep_description(data_folder, source, text)
    choose_packages(data_folder, file, text, indexes)
    return file
