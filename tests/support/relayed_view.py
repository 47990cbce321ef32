"""A scene, a relay of it, and the line between them that can be slow or cut."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from typing_extensions import override

from studio.scene import DocumentScene
from studio.scene.relayed import RelayedScene
from tests.support.page_state import PageState, WatchingPeer
from tests.support.viser_frames import Peer, eventually

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable


class Line(Peer):
    """The relay's page at the origin: what comes goes into the relay at once."""

    def __init__(self, relay: RelayedScene) -> None:
        super().__init__()
        self._relay = relay
        self._is_first = True
        self.carried: list[bytes] = []

    @override
    def write(self, data: bytes, /) -> None:
        self.carried.append(data)
        self._relay.take(data, is_first=self._is_first)
        self._is_first = False
        if not self.reads:
            self.unread_bytes += len(data)


class RelayedView:
    """An origin with a relay; `connect` opens the line, again after a cut."""

    def __init__(self) -> None:
        self.loop = asyncio.get_running_loop()
        self.scene = DocumentScene(self.loop)
        self.relay = RelayedScene(self.loop)
        self.line = Line(self.relay)

    async def connect(self) -> None:
        """Open the line; the first frame has come."""
        self.line = Line(self.relay)
        self.line.serving = asyncio.create_task(self.scene.serve(self.line, lambda _: True))
        await eventually(lambda: bool(self.line.carried))

    async def cut(self) -> None:
        """Close the line."""
        self.line.leave()
        if self.line.serving is not None:
            await self.line.serving

    async def seated(self) -> WatchingPeer:
        """A page at the relay that has what the relay has."""
        peer = WatchingPeer()
        peer.serving = asyncio.create_task(self.relay.serve(peer, lambda _: True))
        await eventually(lambda: bool(peer.frames))
        return peer

    async def state_at_the_origin(self) -> PageState:
        """What a page has that comes to the origin now."""
        peer = WatchingPeer()
        peer.serving = asyncio.create_task(self.scene.serve(peer, lambda _: True))
        await eventually(lambda: bool(peer.look().ends_of_replay))
        peer.leave()
        await peer.serving
        return peer.state


def relayed(scenario: Callable[[RelayedView], Awaitable[None]]) -> None:
    """Run a scenario on a view and its relay, which are connected."""

    async def run() -> None:
        view = RelayedView()
        await view.connect()
        try:
            await scenario(view)
        finally:
            view.relay.close()
            view.scene.close()
            await asyncio.sleep(0)

    asyncio.run(run())
