"""What the server room uses of the engine and of a document's 3D view."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from studio.server.cookies import KnowsMembers
from studio.server.joining import Joins

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Awaitable, Callable, Iterator, Mapping, Sequence
    from pathlib import Path

    from studio.documents.exports import Download, MeshNames
    from studio.live.topics.browsers import DataLaneEnd
    from studio.protocol import Command
    from studio.protocol.listeners import Listener
    from studio.protocol.subscriptions import SubscriptionCommand
    from studio.scene import Connection


class OpenScene(Protocol):
    """The 3D view of one document."""

    def serve(
        self, connection: Connection, allowed: Callable[[str], bool], subprotocol: str | None
    ) -> Awaitable[None]:
        """Speak viser's protocol until the connection ends."""
        ...


class MakesDownloads(Protocol):
    """A document for other programs. Each raises a StudioError when it cannot be made."""

    async def urdf(self, meshes: MeshNames, /) -> Download:
        """Return the expanded URDF."""
        ...

    async def package(self, *, all_used: bool) -> Download:
        """Return the robot's package as a zip, or all that it uses."""
        ...

    async def page(self, *, dark: bool) -> Download:
        """Return the 3D view as a page of its own."""
        ...


class MakesTables(Protocol):
    """Numbers over the recording that a document shows."""

    async def table(self, lines: Sequence[tuple[str, str]], /) -> Iterator[bytes]:
        """Return all samples of numbers over a recording, by topic and path, as CSV.

        Raises:
            StudioError: Not all were read yet, or there are none.
        """
        ...


class ShowsTime(Protocol):
    """The time that a document shows."""

    @property
    def series(self) -> MakesTables:
        """Numbers over it."""
        ...


class OpenDocument(Protocol):
    """One document."""

    @property
    def time(self) -> ShowsTime:
        """The time that it shows."""
        ...

    @property
    def scene(self) -> OpenScene:
        """Its 3D view."""
        ...

    @property
    def exports(self) -> MakesDownloads:
        """Makes what can be downloaded of it."""
        ...


class TakesUploads(Protocol):
    """Keeps and opens the files that are sent."""

    async def take(self, manifest: bytes, chunks: AsyncIterator[bytes], beside: str, /) -> str:
        """Keep and open them; gives the document's id, which is `beside` if that shows a bag now.

        Raises:
            StudioError: They cannot be kept, or are neither a robot nor a bag.
        """
        ...


class SubscribesTopics(Protocol):
    """Subscribes topics for browsers."""

    def attach(self, lane: DataLaneEnd, /, most: int = ...) -> None:
        """A data lane was opened, which may have so many subscriptions at most."""
        ...

    def detach(self, lane: DataLaneEnd, /) -> None:
        """Remove a closed lane."""
        ...

    def carry_out(self, lane: DataLaneEnd, command: SubscriptionCommand, /) -> None:
        """Subscribe or unsubscribe for a browser, and send it the state."""
        ...


class HandedCopies(Protocol):
    """Copies that were handed in."""

    def download(self) -> Download:
        """Return all of them as a zip.

        Raises:
            CommandError: Nobody handed one in.
        """
        ...


class SharedClass(KnowsMembers, Joins, Protocol):
    """The class."""

    async def log_out(self) -> None:
        """Make all members' cookies invalid."""
        ...


class OpenDocuments(Protocol):
    """The engine."""

    @property
    def browser_topics(self) -> SubscribesTopics:
        """The subscriptions of browsers."""
        ...

    @property
    def classroom(self) -> SharedClass:
        """The class that shares it."""
        ...

    @property
    def copies(self) -> HandedCopies:
        """The copies of the class."""
        ...

    @property
    def bags_folder(self) -> Path:
        """Where topics are recorded, a folder for each bag."""
        ...

    def is_writing(self, folder: Path, /) -> bool:
        """Whether a bag is recorded or written into a folder now."""
        ...

    @property
    def uploads(self) -> TakesUploads:
        """Takes what is dropped on the page."""
        ...

    @property
    def default_document(self) -> str | None:
        """Id of the document that `/` leads to."""
        ...

    @property
    def documents(self) -> Mapping[str, OpenDocument]:
        """Every open document by its id."""
        ...

    def document(self, id: str, /) -> OpenDocument:  # noqa: A002 - the engine's own word
        """Return one document.

        Raises:
            UnknownDocumentError: No open document has that id.
        """
        ...

    def check(self, id: str, /) -> None:  # noqa: A002 - as above
        """Pass if there is a document of that id, open or resting.

        Raises:
            UnknownDocumentError: There is none.
        """
        ...

    async def ready(self, id: str, /) -> OpenDocument:  # noqa: A002 - as above
        """Return one document, as `document`; one that rests is opened first."""
        ...

    def attach(self, listener: Listener, /) -> None:
        """Send it the list of documents, now and whenever it changes."""
        ...

    def detach(self, listener: Listener, /) -> None:
        """Forget it, whatever it watched."""
        ...

    async def execute(self, command: Command, listener: Listener, /) -> None:
        """Carry out one command and answer its listener.

        Raises:
            StudioError: It cannot be done.
        """
        ...
