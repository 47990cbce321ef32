"""DeedDesk: all that is done from pages in a ROS 2 system, and who is told how it fares."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.live.panels.calls import CallDesk
from studio.live.panels.goal_statuses import GoalStatusDesk
from studio.live.panels.goals import GoalDesk
from studio.live.panels.offers import OfferDesk
from studio.live.panels.parameters import ParameterDesk
from studio.live.panels.publishing import PublishDesk
from studio.protocol.calls import FollowDeeds
from studio.protocol.commands import Commands, Scope

if TYPE_CHECKING:
    from studio.live.connection.desk import WireDesk
    from studio.live.panels.interfaces import InterfaceDesk
    from studio.live.panels.logs import LogDesk
    from studio.protocol.listeners import Listener


class DeedDesk:
    """Holds one desk for each kind of deed."""

    def __init__(self, wire: WireDesk, interfaces: InterfaceDesk, logs: LogDesk) -> None:
        self.offers = OfferDesk(wire, interfaces)
        self.calls = CallDesk(wire)
        self.goals = GoalDesk(wire, logs)
        self.statuses = GoalStatusDesk(wire, self.goals.own_ids)
        self.publishing = PublishDesk(wire)
        self.parameters = ParameterDesk(wire)
        self._ledgers = {
            "calls": self.calls.ledger,
            "goals": self.goals.ledger,
            "publications": self.publishing.ledger,
        }

    def follow(self, command: FollowDeeds, listener: Listener) -> None:
        """Tell a page of a kind of deeds, or no more."""
        ledger = self._ledgers[command.deeds]
        if command.following:
            ledger.follow(listener)
        else:
            ledger.unfollow(listener)

    def attach(self, listener: Listener) -> None:
        """A page is there."""
        self.publishing.attach(listener)

    def detach(self, listener: Listener) -> None:
        """A page is gone: what it began goes on and is shown to the others.

        Only what is published again and again ends when no page is left that could stop it.
        """
        for ledger in self._ledgers.values():
            ledger.unfollow(listener)
        self.parameters.detach(listener)
        self.publishing.detach(listener)

    async def let_go(self) -> None:
        """End all: the connection is about to."""
        parts = (self.calls, self.goals, self.statuses, self.publishing, self.parameters)
        await asyncio.gather(*(one.let_go() for one in parts))

    async def close(self) -> None:
        """End all that runs, and tell nobody any more."""
        await self.let_go()
        parts = (self.calls, self.goals, self.publishing, self.parameters)
        await asyncio.gather(*(one.close() for one in parts))


COMMANDS: Final = Commands[DeedDesk](Scope.ROS)
COMMANDS.viewer(FollowDeeds, lambda one, c, who: one.follow(c, who))
