"""DeedDesk: all that is done from pages in a ROS 2 system, and who is told how it fares."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.engine.bridge.calls import CallDesk
from studio.engine.bridge.offers import OfferDesk

if TYPE_CHECKING:
    from studio.engine.bridge.interfaces import InterfaceDesk
    from studio.engine.listeners import Listener
    from studio.engine.messages.calls import FollowDeeds
    from studio.engine.wire.desk import WireDesk


class DeedDesk:
    """Holds one desk for each kind of deed."""

    def __init__(self, wire: WireDesk, interfaces: InterfaceDesk) -> None:
        self.offers = OfferDesk(wire, interfaces)
        self.calls = CallDesk(wire)
        self._ledgers = {"calls": self.calls.ledger}
        self._desks = (self.calls,)

    def follow(self, command: FollowDeeds, listener: Listener) -> None:
        """Tell a page of a kind of deeds, or no more."""
        ledger = self._ledgers[command.deeds]
        if command.following:
            ledger.follow(listener)
        else:
            ledger.unfollow(listener)

    def detach(self, listener: Listener) -> None:
        """A page is gone: what it began goes on, and is shown to the others."""
        for ledger in self._ledgers.values():
            ledger.unfollow(listener)

    async def let_go(self) -> None:
        """End all: the connection is about to."""
        await asyncio.gather(*(desk.let_go() for desk in self._desks))

    async def close(self) -> None:
        """End all that runs, and tell nobody any more."""
        await asyncio.gather(*(desk.close() for desk in self._desks))
