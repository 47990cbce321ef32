"""The 3D views of a room at a relay, opened when somebody looks; large parts are kept."""

from __future__ import annotations

import asyncio
import itertools
from collections import deque
from typing import TYPE_CHECKING, Final

from studio.errors import SceneError
from studio.scene.frame_parts import join_frame
from studio.scene.relayed import RelayedScene
from studio.server.relays.messages import CloseScene, OpenScene, SceneFrame, WantBlobs

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.scene import Connection
    from studio.scene.frame_parts import BlobStore
    from studio.server.relays.messages import Blob, Up

_IDLE_S: Final = 60.0
_WAITING_MAX: Final = 1_000
"""Frames that wait for parts of one before them; then the view is asked for anew."""
_WAITING_BYTES_MAX: Final = 64 << 20


class SceneHere:
    """One 3D view, and its frames that are not whole yet."""

    def __init__(self, document: str) -> None:
        loop = asyncio.get_running_loop()
        self.document, self.scene = document, RelayedScene(loop)
        self.opening = 0
        """Number of the last `OpenScene`; frames of those before are too late."""
        self.looking = 0
        self.idle_since_s = loop.time()
        self.waiting: deque[SceneFrame] = deque()
        self.waiting_bytes = 0
        self.missing: set[bytes] = set()
        """Digests of what the first of them lacks, besides what is on the way for the others."""

    def clear(self) -> None:
        """Forget the frames that wait."""
        self.waiting.clear()
        self.missing.clear()
        self.waiting_bytes = 0


class RelayedScenes:
    """Used on the event loop only.

    Args:
        send: To the origin.
        ticket_for: Gives the ticket of somebody who may see a document.
        blobs: Large parts, shared by all rooms.
    """

    def __init__(
        self,
        send: Callable[[Up], object],
        ticket_for: Callable[[str], str],
        blobs: BlobStore,
    ) -> None:
        self._send, self._ticket_for, self._blobs = send, ticket_for, blobs
        self._scenes: dict[str, SceneHere] = {}
        self._openings = itertools.count(1)
        self.frame_count = 0

    async def serve(
        self,
        document: str,
        connection: Connection,
        allowed: Callable[[str], bool],
        subprotocol: str | None,
    ) -> None:
        """Show a 3D view to a page until it leaves."""
        here = self._scenes.get(document)
        if here is None:
            here = self._scenes[document] = SceneHere(document)
            self._ask_for(here)
        here.looking += 1
        try:
            await here.scene.serve(connection, allowed, subprotocol)
        finally:
            here.looking -= 1
            here.idle_since_s = asyncio.get_running_loop().time()

    def take(self, message: SceneFrame) -> None:
        """Take a frame: shown at once, or when its parts are there.

        Raises:
            SceneError: It is none.
        """
        here = self._scenes.get(message.document)
        if here is None or message.opening != here.opening:
            return
        if len(message.parts) != len(message.is_digest):
            raise SceneError("It is not said of each part of a frame what it is.")
        digests = set(itertools.compress(message.parts, message.is_digest))
        if digests:
            lacking = {one for one in digests if self._blobs.get(one) is None}
            here.missing |= lacking
            wanted = tuple(lacking - set(message.announced))
            self._send(WantBlobs(message.document, here.opening, wanted))
        here.waiting.append(message)
        here.waiting_bytes += sum(map(len, message.parts))
        if len(here.waiting) > _WAITING_MAX or here.waiting_bytes > _WAITING_BYTES_MAX:
            self._open_anew(here)
        self._show(here)

    def take_blob(self, blob: Blob) -> None:
        """Keep a large part, and show what waited for it.

        Raises:
            SceneError: It is not what its digest says.
        """
        wanting = [here for here in self._scenes.values() if blob.digest in here.missing]
        if not wanting:
            return  # nobody asked for it: it would only take the place of others'
        self._blobs.put(blob.digest, blob.data)
        for here in wanting:
            here.missing.discard(blob.digest)
            self._show(here)

    def end(self, document: str) -> None:
        """There is no such view, or no more: its pages are let go."""
        if here := self._scenes.pop(document, None):
            here.scene.close()

    def reset(self) -> None:
        """The origin went: what waits for parts never gets them."""
        for here in self._scenes.values():
            here.clear()

    def renew(self) -> None:
        """The origin is there again: open anew what is looked at."""
        for here in self._scenes.values():
            self._ask_for(here)

    def close_idle(self) -> None:
        """End views that nobody has looked at for a while."""
        now_s = asyncio.get_running_loop().time()
        for name, here in tuple(self._scenes.items()):
            if not here.looking and now_s - here.idle_since_s > _IDLE_S:
                self._send(CloseScene(name))
                self.end(name)

    def close(self) -> None:
        """End all."""
        for name in tuple(self._scenes):
            self.end(name)

    def _show(self, here: SceneHere) -> None:
        """Show the frames that are whole, in their order."""
        while here.waiting:
            message = here.waiting[0]
            try:
                frame = join_frame(message.parts, message.is_digest, self._blobs.get)
            except SceneError:
                if not here.missing:  # it was given up for others meanwhile
                    self._open_anew(here)
                return
            here.waiting.popleft()
            here.waiting_bytes -= sum(map(len, message.parts))
            self.frame_count += 1
            here.scene.take(frame, is_first=message.is_first)

    def _open_anew(self, here: SceneHere) -> None:
        here.clear()
        self._ask_for(here)

    def _ask_for(self, here: SceneHere) -> None:
        here.opening = next(self._openings)
        document = here.document
        self._send(OpenScene(document, here.opening, self._ticket_for(document)))
