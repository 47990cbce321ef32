"""What the origin sends to a relay as it sends it to pages: lanes of events, and 3D views."""

from __future__ import annotations

import asyncio
from collections import deque
from functools import cache
from typing import TYPE_CHECKING, Final

from studio.protocol.documents import Gone
from studio.protocol.message import all_events, type_of
from studio.protocol.roles import RELAY, Role, owner_of
from studio.scene import SUBPROTOCOL
from studio.scene.frame_parts import split_frame
from studio.server.relays.messages import (
    MOMENT,
    Blob,
    Frame,
    LaneFrame,
    LaneSnapshot,
    Say,
    SceneFrame,
    encode,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.outlet import Outlet
    from studio.protocol.roles import Person
    from studio.server.relays.line import Line
    from studio.server.surface import OpenScene


class OriginLane:
    """A Listener to which the studio sends what a guest's page gets, for all of a relay's pages.

    Args:
        lane: Its name.
        outlet: Where its frames go.
        before: Called before each.
        sees: Whether it may show what is in a document.
        ended: Called once what it shows is no more.
    """

    def __init__(
        self,
        lane: str,
        outlet: Outlet,
        before: Callable[[], object],
        sees: Callable[[str], bool],
        ended: Callable[[OriginLane], object],
    ) -> None:
        self.lane, self._sees, self._ended = lane, sees, ended
        self.role, self.person = Role.GUEST, RELAY
        self._outlet, self._before = outlet, before
        self._collected: list[Frame] | None = None

    def controls(self, document: str) -> bool:
        """Return that a relay controls nothing."""
        del document
        return False

    def sees(self, document: str) -> bool:
        """Whether it may show what is in a document."""
        return self._sees(document)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Send one message, or have it in the snapshot that is being made."""
        kind = "" if binary else data[len(_TYPE) : data.find(b'"', len(_TYPE))].decode()
        frame = Frame(data, binary, MOMENT if kind in _moments() else key or "")
        if self._collected is not None:
            self._collected.append(frame)
            return
        if kind == _GONE:
            self._ended(self)
        if not binary:  # what depends on it is text; joints and views come sixty times a second
            self._before()
        place = f"{self.lane}\0{key}" if key else None
        self._outlet.post(encode(LaneFrame(self.lane, frame)), place)

    def begin_snapshot(self) -> None:
        """Collect the whole state, which is posted now."""
        self._collected = []

    def end_snapshot(self) -> None:
        """Send it."""
        frames, self._collected = self._collected or [], None
        self._before()
        self._outlet.post(encode(LaneSnapshot(self.lane, tuple(frames))))


class RelayedPage:
    """A page at a relay, as the studio knows it: who it is, and where its own answers go."""

    def __init__(
        self, page: int, visitor: Person, outlet: Outlet, before: Callable[[], object]
    ) -> None:
        self.page, self._visitor = page, visitor
        self.person = visitor.person
        self._outlet, self._before = outlet, before

    @property
    def role(self) -> Role:
        """The role of its person, now."""
        return self._visitor.role

    @property
    def visitor(self) -> Person:
        """Its person."""
        return self._visitor

    def controls(self, document: str) -> bool:
        """Whether its person has control."""
        return self._visitor.controls(document)

    def sees(self, document: str) -> bool:
        """Whether its person may look at a document."""
        return self._visitor.sees(document)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Send one message to this page alone."""
        self._before()
        place = f"{self.page}\0{key}" if key else None
        self._outlet.post(encode(Say(self.page, Frame(data, binary, key or ""))), place)


class OriginScene:
    """One 3D view of the studio, shown to a relay as to a page that only looks."""

    def __init__(
        self, document: str, opening: int, line: Line, may_go_on: Callable[[], bool]
    ) -> None:
        self._document, self._opening = document, opening
        self._line, self._may_go_on = line, may_go_on
        self._is_first = True
        self._ended = asyncio.Event()
        self._resume: Callable[[], object] = lambda: None
        self._unasked: deque[dict[bytes, memoryview]] = deque()
        """What the digests of each frame stand for, until the relay has said which it has not."""
        self._sent = set[bytes]()
        """Digests that were named, whose bytes the relay has or has asked for."""
        self._blobs: deque[tuple[bytes, memoryview]] = deque()
        """What it wants, and was not sent yet."""
        line.on_drain(self._go_on)

    async def serve(self, scene: OpenScene) -> None:
        """Show it until it is closed."""
        watching = asyncio.create_task(self._watch()) if owner_of(self._document) else None
        try:
            await scene.serve(self, lambda _: False, SUBPROTOCOL)
        finally:
            if watching is not None:
                watching.cancel()
            self._line.off_drain(self._go_on)

    async def receive(self) -> bytes | None:
        """Wait for the end: a relay says nothing to a 3D view."""
        await self._ended.wait()
        return None

    def write(self, data: bytes, /) -> None:
        """Send one frame."""
        parts, is_digest, blobs = split_frame(data)
        first, self._is_first = self._is_first, False
        if blobs:
            self._unasked.append(blobs)
        # What is new in a later frame goes along: to be asked for it would take time each time.
        announced = () if first else tuple(blobs.keys() - self._sent)
        self._sent |= blobs.keys()
        if len(self._sent) > _DIGESTS_MAX:
            self._sent = set(blobs)
        where = self._document, self._opening
        self._line.send(SceneFrame(*where, first, tuple(parts), tuple(is_digest), announced))
        for digest in announced:
            self._line.send(Blob(digest, bytes(blobs[digest])))

    def wanted(self, opening: int, digests: tuple[bytes, ...]) -> None:
        """The relay has none of these, which the oldest frame with digests names."""
        if self._unasked and opening == self._opening:
            blobs = self._unasked.popleft()
            self._blobs += [(one, blobs[one]) for one in digests if one in blobs]
            self._send_blobs()

    def pending_bytes(self) -> int:
        """Bytes on the way that the relay has not confirmed."""
        return self._line.pending_bytes()

    def on_drain(self, resume: Callable[[], object], /) -> None:
        """Call `resume` when there is room again."""
        self._resume = resume

    def close(self, code: int = 1000, /) -> None:
        """End it."""
        del code
        self._ended.set()

    def _go_on(self) -> None:
        self._send_blobs()
        self._resume()

    def _send_blobs(self) -> None:
        """Send as many as the line takes: what is urgent goes between them."""
        while self._blobs and not self._line.pending_bytes():
            digest, data = self._blobs.popleft()
            self._line.send(Blob(digest, bytes(data)))

    async def _watch(self) -> None:
        """End it once nobody at the relay may look at the copy any more."""
        while self._may_go_on():  # noqa: ASYNC110 - nobody tells it
            await asyncio.sleep(_LOOK_EVERY_S)
        self.close()


@cache
def _moments() -> frozenset[str]:
    return frozenset(type_of(kind) for kind in all_events() if kind.is_moment)


_TYPE: Final = b'{"type":"'
_GONE: Final = type_of(Gone)
_LOOK_EVERY_S: Final = 1.0
_DIGESTS_MAX: Final = 10_000
