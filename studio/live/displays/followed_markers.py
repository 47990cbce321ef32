"""FollowedMarkers: the interactive markers of a document, from its first display of them on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.markers import InteractWithMarker

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from studio.live.connection.link import WireLink
    from studio.live.displays.drawing_room import DrawingRoom
    from studio.live.displays.marker_servers import MarkerServers
    from studio.protocol import Event
    from studio.protocol.listeners import Audience, Listener

_KIND: Final = "InteractiveMarkers"


class FollowedMarkers:
    """Has the servers followed; what does so imports Zenoh, and is made when it is needed."""

    def __init__(self, audience: Audience) -> None:
        self._audience = audience
        self._servers: MarkerServers | None = None

    def step(self, room: DrawingRoom, shown: Collection[str], link: WireLink | None) -> None:
        """Let the clients of the displays work that are switched on."""
        displays = room.displays()
        if self._servers is None:
            if not any(one.KIND == _KIND for one in displays.values()):
                return
            from studio.live.displays.marker_servers import (  # noqa: PLC0415 - imports zenoh
                MarkerServers,
            )

            self._servers = MarkerServers(room.frames, self._audience.send)
        self._servers.step({name: displays[name] for name in shown if name in displays}, link)

    def events(self) -> Iterator[Event]:
        """Yield what a new page is sent."""
        if self._servers is not None:
            yield self._servers.event

    async def interact(self, command: InteractWithMarker, who: Listener) -> None:
        """Do something to a marker.

        Raises:
            CommandError: It is gone, somebody else drags it, or nothing can be done so.
        """
        if self._servers is None:
            raise CommandError("There is no display of interactive markers any more.")
        await self._servers.interact(command, who)

    def let_go(self) -> None:
        """Receive nothing more: the connection is about to end."""
        if self._servers is not None:
            self._servers.let_go()

    async def close(self) -> None:
        """End all that is running."""
        if self._servers is not None:
            await self._servers.close()


COMMANDS: Final = Commands[FollowedMarkers](Scope.ROS)
COMMANDS.controller(
    InteractWithMarker,
    lambda markers, c, who: markers.interact(c, who),
    needs_router=True,
    limits=Limits(bytes_max=2_000, per_second=150),
)
