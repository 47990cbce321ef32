"""The surface that the web room needs, with one open document and answers that tests can steer."""

from __future__ import annotations

import asyncio
import os
from pathlib import Path
from typing import TYPE_CHECKING

from starlette.requests import ClientDisconnect

from studio.classroom.classroom import Classroom
from studio.documents.exports import Download
from studio.errors import (
    ExportError,
    RecordingError,
    SaveConflictError,
    UnknownDocumentError,
    UploadError,
)
from studio.live.topics.frames import Tick, chunk_of
from studio.protocol.documents import CloseDocument, DocumentEntry, Documents, Done
from studio.protocol.edits import Redo, Undo
from studio.protocol.listeners import send
from studio.protocol.robot import AnimateJoints, RandomizeJoints, ZeroJoints
from studio.protocol.saving import Reload, Save
from studio.protocol.subscriptions import NotSubscribed, Subscribe
from studio.protocol.texts import GetUrdf, Urdf
from studio.ros.attachment import Attachment
from studio.ros.node.samples import RawSample
from studio.scene import SUBPROTOCOL

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterator, Sequence

    from studio.documents.exports import MeshNames
    from studio.live.topics.browsers import DataLaneEnd
    from studio.protocol import Command
    from studio.protocol.listeners import Listener
    from studio.protocol.subscriptions import SubscriptionCommand
    from studio.scene import Connection

FLOOD = 40
"""Messages of one megabyte that `randomize_joints` and `animate_joints` (one key) bring about."""
URDF = "<robot name='small'/>"


class SmallScene:
    """Echoes every message whose text is an allowed message type; `close` ends the connection."""

    async def serve(
        self, connection: Connection, allowed: Callable[[str], bool], subprotocol: str | None
    ) -> None:
        if subprotocol != SUBPROTOCOL:
            connection.close(1002)
        while (message := await connection.receive()) is not None:
            if message == b"close":
                connection.close(4000)
            elif allowed(message.decode()):
                connection.write(message)


class SmallExports:
    """Downloads that hold what was asked for."""

    async def urdf(self, meshes: MeshNames, /) -> Download:
        return Download("small 'robot\" ü🤖\r\n.urdf", "application/xml", (meshes.encode(),))

    async def package(self, *, all_used: bool) -> Download:
        return Download("small.zip", "application/zip", (b"used" if all_used else b"entry", b"!"))

    async def page(self, *, dark: bool) -> Download:
        if not dark:
            raise ExportError("small", "it has no light")
        return Download("small.html", "text/html", (b"page",))


class SmallSeries:
    """One table, of which `/none` has nothing."""

    async def table(self, lines: Sequence[tuple[str, str]], /) -> Iterator[bytes]:
        if ("/none", ".x") in lines:
            raise RecordingError("/none has no number.")
        return iter((b"topic,path\n", *(f"{topic},{path}\n".encode() for topic, path in lines)))


class SmallTime:
    def __init__(self) -> None:
        self.series = SmallSeries()


class SmallDocument:
    def __init__(self) -> None:
        self.time = SmallTime()
        self.scene = SmallScene()
        self.exports = SmallExports()


class SmallCopies:
    """One copy, handed in."""

    def download(self) -> Download:
        return Download("copies.zip", "application/zip", (b"copies",))


class SmallUploads:
    """Keeps what is sent in memory, and opens it as the small document."""

    def __init__(self) -> None:
        self.taken: list[tuple[bytes, bytes]] = []
        self.begun = self.broken = 0

    async def take(self, manifest: bytes, chunks: AsyncIterator[bytes], beside: str, /) -> str:
        if manifest == b"refuse":
            raise UploadError("the small engine is in no mood.")
        self.begun += 1
        try:
            content = b"".join([chunk async for chunk in chunks])
        except ClientDisconnect:
            self.broken += 1
            raise
        self.taken.append((manifest, content))
        return "small"


class SmallTopics:
    """Says that nothing is subscribed, but for `/flood`, and keeps the commands."""

    def __init__(self) -> None:
        self.hearers: list[DataLaneEnd] = []
        self.commands: list[SubscriptionCommand] = []
        self.flooded = 0

    def attach(self, lane: DataLaneEnd, /, most: int = 0) -> None:
        self.hearers.append(lane)

    def detach(self, lane: DataLaneEnd, /) -> None:
        self.hearers.remove(lane)

    def carry_out(self, lane: DataLaneEnd, command: SubscriptionCommand, /) -> None:
        self.commands.append(command)
        if isinstance(command, Subscribe) and command.topic == "/flood":
            for number in range(FLOOD):
                sample = RawSample(b"%d" % number + bytes(1 << 20), Attachment(1, 1, b""), 1)
                both = (chunk_of(at, [sample], 0, keeps_all=at == 1) for at in (1, 2))
                lane.take(Tick(tuple(both)))
                self.flooded += 1
        lane.send(NotSubscribed(subscription=command.subscription, reason="there is no such topic"))


BAG = bytes(range(256))


class SmallEngine:
    """Saving conflicts, undo has a bug, redo waits until `go_on`, closing cancels
    what it waits for; all else is done at once."""

    def __init__(self) -> None:
        self.documents = {"small": SmallDocument()}
        self.classroom = Classroom()
        self.uploads, self.copies = SmallUploads(), SmallCopies()
        self.browser_topics = SmallTopics()
        self.bags_folder = Path(os.environ["STUDIO_DATA_DIR"]) / "bags"
        self.written: set[Path] = set()
        self.is_writing = self.written.__contains__
        (self.bags_folder / "bag").mkdir(parents=True, exist_ok=True)
        (self.bags_folder / "bag" / "bag_0.mcap").write_bytes(BAG)
        self.default_document: str | None = "small"
        self.executed: list[Command] = []
        self.listeners: list[Listener] = []
        self.go_on = asyncio.Event()

    def document(self, name: str, /) -> SmallDocument:
        if name not in self.documents:
            raise UnknownDocumentError(name)
        return self.documents[name]

    def check(self, name: str, /) -> None:
        self.document(name)

    async def ready(self, name: str, /) -> SmallDocument:
        return self.document(name)

    def attach(self, listener: Listener, /) -> None:
        self.listeners.append(listener)
        entry = DocumentEntry(id="small", title="small", path="small.urdf", unsaved=False)
        send(listener, Documents(documents=(entry,)))

    def detach(self, listener: Listener, /) -> None:
        if listener in self.listeners:
            self.listeners.remove(listener)

    async def execute(self, command: Command, listener: Listener, /) -> None:
        self.executed.append(command)
        match command:
            case GetUrdf():
                self.document(command.document)
                send(listener, Urdf(request=command.request, text=URDF))
            case Save():
                raise SaveConflictError("small.urdf")
            case Undo():
                raise RuntimeError("a bug")
            case Redo() | Reload():
                await self._wait(command)
            case ZeroJoints():
                for number in range(3):
                    listener.post(bytes([1, number]), binary=True, key="joints")
            case CloseDocument():
                waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
                waiter.cancel()
                await waiter
            case RandomizeJoints() | AnimateJoints():
                key = "joints" if command.type == "animate_joints" else None
                for number in range(FLOOD):
                    listener.post(b"%d" % number + bytes(1 << 20), binary=True, key=key)
            case _:
                pass
        send(listener, Done(request=command.request))

    async def _wait(self, command: Redo | Reload) -> None:
        if isinstance(command, Reload):
            self.go_on.set()
        await self.go_on.wait()
