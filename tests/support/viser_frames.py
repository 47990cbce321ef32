"""Reads the frames that viser's page would get."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, TypeAlias

import msgspec
import zstandard

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.scene import DocumentScene

Sent: TypeAlias = dict[str, Any]


def messages_of(frame: bytes) -> list[Sent]:
    """The messages of one frame; arrays stay placeholders."""
    packed_size = int.from_bytes(frame[8:16], "little")
    inner = zstandard.ZstdDecompressor().decompress(frame[16 : 16 + packed_size])
    return msgspec.msgpack.decode(inner)["messages"]


async def eventually(holds: Callable[[], bool]) -> None:
    """Let the loop run until that holds."""
    async with asyncio.timeout(60):
        while not holds():  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0)


class Peer:
    """A Connection of which the test is the other end: `read` takes what came."""

    def __init__(self) -> None:
        self.frames: list[bytes] = []
        self.unread_bytes = 0
        self.closed_with: int | None = None
        self.reads = True
        self.serving: asyncio.Task[None] | None = None
        self._inbox: asyncio.Queue[bytes | None] = asyncio.Queue()

    async def receive(self) -> bytes | None:
        return await self._inbox.get()

    def write(self, data: bytes, /) -> None:
        self.frames.append(data)
        if not self.reads:
            self.unread_bytes += len(data)

    def pending_bytes(self) -> int:
        return self.unread_bytes

    def on_drain(self, resume: Callable[[], object], /) -> None:
        self._resume = resume

    def close(self, code: int, /) -> None:
        self.closed_with = code
        self._inbox.put_nowait(None)

    def send(self, **message: object) -> None:
        """Say something to the server."""
        self._inbox.put_nowait(msgspec.msgpack.encode(message))

    def send_raw(self, data: bytes) -> None:
        self._inbox.put_nowait(data)

    def leave(self) -> None:
        self._inbox.put_nowait(None)

    def stall(self) -> None:
        """Read nothing from now on."""
        self.reads, self.unread_bytes = False, 1 << 30

    def go_on(self) -> None:
        """Read again, all at once."""
        self.reads, self.unread_bytes = True, 0

    def drain(self) -> None:
        """Read again, and say at once that there is room."""
        self.go_on()
        self._resume()

    def read(self) -> list[Sent]:
        """The messages that came since the last time, in order."""
        frames, self.frames = self.frames, []
        return [message for frame in frames for message in messages_of(frame)]

    async def until(self, arrived: Callable[[list[Sent]], bool]) -> list[Sent]:
        """Read on until that holds of all that was read here."""
        read: list[Sent] = []

        def more() -> bool:
            read.extend(self.read())
            return arrived(read)

        await eventually(more)
        return read


def sit_down(
    scene: DocumentScene, peer: Peer, allowed: Callable[[str], bool] = lambda _: True
) -> asyncio.Task[None]:
    """Connect a peer."""
    return asyncio.create_task(scene.serve(peer, allowed))


async def joined(scene: DocumentScene) -> tuple[Peer, list[Sent]]:
    """A peer that has got the whole state, and that state."""
    peer = Peer()
    peer.serving = sit_down(scene, peer)
    return peer, await peer.until(lambda read: "ReplayDoneMessage" in types_of(read))


def types_of(sent: list[Sent]) -> list[str]:
    return [message["type"] for message in sent]


def told_of(sent: list[Sent]) -> set[str]:
    """Names of the nodes that these messages speak of."""
    return {message["name"] for message in sent if "name" in message}
