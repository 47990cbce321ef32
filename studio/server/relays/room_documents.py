"""A document of a room at a relay, as the routes use one; and the parts that a relay has not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterator, Sequence

    from studio.documents.exports import Download, MeshNames
    from studio.scene import Connection
    from studio.server.relays.relayed_scenes import RelayedScenes


class Room(Protocol):
    """The room."""

    @property
    def scenes(self) -> RelayedScenes:
        """Its 3D views."""
        ...

    async def download(
        self, document: str, what: str, options: Sequence[tuple[str, str]], /
    ) -> Download:
        """Return what the origin makes of a document."""
        ...


class RoomDocument:
    """One document of a room, as the routes use it."""

    def __init__(self, room: Room, name: str) -> None:
        self._room, self._name = room, name
        self.scene = self.exports = self.time = self.series = self

    async def serve(
        self, connection: Connection, allowed: Callable[[str], bool], subprotocol: str | None
    ) -> None:
        """Show its 3D view to a page."""
        await self._room.scenes.serve(self._name, connection, allowed, subprotocol)

    async def urdf(self, meshes: MeshNames) -> Download:
        """Refuse it."""
        del meshes
        raise CommandError(_ONLY_THERE)

    async def package(self, *, all_used: bool) -> Download:
        """Refuse it."""
        del all_used
        raise CommandError(_ONLY_THERE)

    async def page(self, *, dark: bool) -> Download:
        """Return the 3D view as a page of its own."""
        theme = "dark" if dark else "light"
        return await self._room.download(self._name, "page", [("theme", theme)])

    async def table(self, lines: Sequence[tuple[str, str]]) -> Iterator[bytes]:
        """Return plotted numbers over a recording, as CSV."""
        return iter((await self._room.download(self._name, "series", lines)).chunks)


class OnlyThere:
    """What the studio itself does, and no relay: uploads, and copies that were handed in."""

    async def take(self, manifest: bytes, chunks: AsyncIterator[bytes], beside: str) -> str:
        """Refuse it."""
        raise CommandError(_ONLY_THERE)

    def download(self) -> Download:
        """Refuse it."""
        raise CommandError(_ONLY_THERE)


_ONLY_THERE: Final = "This is done at the studio itself, not by a relay."
