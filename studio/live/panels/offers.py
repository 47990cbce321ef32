"""The services and actions offered, and YAML read as values of a type."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.protocol.calls import (
    Actions,
    GetActions,
    GetServices,
    OfferView,
    ReadValues,
    Services,
    ValuesRead,
)
from studio.protocol.commands import Commands, Scope

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.live.connection.ros_connection import RosConnection
    from studio.live.panels.interfaces import InterfaceTypes
    from studio.ros.graph.endpoints import GraphNode
    from studio.ros.graph.graph import NamesAndTypes


class Offers:
    """Services and actions of the connection's graph; none without a connection."""

    def __init__(self, wire: RosConnection, interfaces: InterfaceTypes) -> None:
        self._wire, self._interfaces = wire, interfaces

    async def services(self, command: GetServices) -> Services:
        """Return the services and their servers."""
        link = self._wire.current
        found: tuple[OfferView, ...] = ()
        if link is not None:
            graph = link.graph

            def servers(name: str) -> list[GraphNode]:
                return [one.node for one in graph.servers(name)]

            found = await asyncio.to_thread(lambda: _offers(graph.services(), servers))
        return Services(request=command.request, services=found)

    async def actions(self, command: GetActions) -> Actions:
        """Return the actions and their servers."""
        link = self._wire.current
        found: tuple[OfferView, ...] = ()
        if link is not None:
            graph = link.graph
            found = await asyncio.to_thread(lambda: _offers(graph.actions(), graph.action_servers))
        return Actions(request=command.request, actions=found)

    async def read(self, command: ReadValues) -> ValuesRead:
        """Read YAML as values of a type.

        Raises:
            StudioError: There is no such type, or a field does not take its value.
        """
        values = await asyncio.to_thread(self._read, command)
        return ValuesRead(request=command.request, values=values)

    def _read(self, command: ReadValues) -> str:
        from studio.ros.types.convert import from_yaml, plain_json  # noqa: PLC0415
        from studio.ros.types.definitions import messages_of  # noqa: PLC0415 - take their time
        from studio.ros.types.yaml_texts import read_yaml  # noqa: PLC0415

        library = self._interfaces.library()
        parts = messages_of(library.interface(command.name))
        if command.place >= len(parts):
            raise CommandError(f"{command.name} has no part {command.place}.")
        from_yaml(library.message(parts[command.place].name), command.text, now_ns=time.time_ns())
        values = read_yaml(command.text)
        return plain_json({} if values is None else values)


def _offers(
    found: NamesAndTypes, servers: Callable[[str], Sequence[GraphNode]]
) -> tuple[OfferView, ...]:
    return tuple(
        OfferView(
            name=name,
            types=tuple(types),
            nodes=tuple(dict.fromkeys(one.path for one in servers(name))),
        )
        for name, types in found
    )


COMMANDS: Final = Commands[Offers](Scope.ROS)
COMMANDS.viewer(GetServices, lambda one, c, _: one.services(c), same_for_all=True)
COMMANDS.viewer(GetActions, lambda one, c, _: one.actions(c), same_for_all=True)
COMMANDS.viewer(ReadValues, lambda one, c, _: one.read(c))
