"""BridgeDesk: carries out what panels ask of the ROS 2 system as a whole."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.errors import RouterGoneError
from studio.live.panels import (
    calls,
    deeds,
    diagnostics,
    driving,
    goal_statuses,
    goals,
    graph,
    interfaces,
    lessons,
    lifecycle,
    logs,
    offers,
    parameters,
    publishing,
    rates,
    topics,
)
from studio.live.panels.deeds import DeedDesk
from studio.live.panels.diagnostics import DiagnosticsDesk
from studio.live.panels.driving import DriveDesk
from studio.live.panels.graph import GraphDesk
from studio.live.panels.hearing import HearingDesk
from studio.live.panels.interfaces import InterfaceDesk
from studio.live.panels.lessons import LessonDesk
from studio.live.panels.lifecycle import LifecycleDesk
from studio.live.panels.logs import LogDesk
from studio.live.panels.rates import RateDesk
from studio.live.panels.topics import TopicDesk
from studio.protocol.commands import Commands, Scope

if TYPE_CHECKING:
    from studio.live.connection.desk import WireDesk
    from studio.protocol.listeners import Listener


class BridgeDesk:
    """Holds one desk for each subject; all run on the loop."""

    def __init__(self, wire: WireDesk) -> None:
        self._wire = wire
        self.interfaces = InterfaceDesk(wire)
        self.hearing = HearingDesk(wire)
        self.topics = TopicDesk(wire)
        self.rates = RateDesk(wire)
        self.logs = LogDesk(wire)
        self.graph = GraphDesk(wire)
        self.lifecycle = LifecycleDesk(wire)
        self.diagnostics = DiagnosticsDesk(wire)
        self.deeds = DeedDesk(wire, self.interfaces, self.logs)
        self.driving = DriveDesk(wire)
        self.lessons = LessonDesk(wire)

    def check_router(self) -> None:
        """Pass if the router is there, or if there is no connection yet: one is made then.

        Raises:
            RouterGoneError: The router is away.
        """
        link = self._wire.current
        if link is not None and not link.is_connected:
            raise RouterGoneError(link.endpoint)

    def attach(self, listener: Listener) -> None:
        """A page is there."""
        self.deeds.attach(listener)

    def detach(self, listener: Listener) -> None:
        """A page is gone: what ran for it alone ends."""
        self.deeds.detach(listener)
        self.driving.detach(listener)

    async def let_go(self) -> None:
        """Let go of the connection, which is about to end."""
        await asyncio.gather(
            self.hearing.let_go(),
            self.deeds.let_go(),
            self.driving.let_go(),
            self.lessons.let_go(),
            self.logs.let_go(),
            self.lifecycle.let_go(),
            self.diagnostics.let_go(),
        )

    async def close(self) -> None:
        """End all that runs."""
        await asyncio.gather(
            self.hearing.close(),
            self.deeds.close(),
            self.driving.let_go(),
            self.lessons.close(),
            self.lifecycle.let_go(),
        )


COMMANDS: Final = Commands[BridgeDesk](Scope.ROS)
COMMANDS.include(interfaces.COMMANDS, lambda bridge, _: bridge.interfaces)
COMMANDS.include(rates.COMMANDS, lambda bridge, _: bridge.rates)
COMMANDS.include(offers.COMMANDS, lambda bridge, _: bridge.deeds.offers)
COMMANDS.include(deeds.COMMANDS, lambda bridge, _: bridge.deeds)
COMMANDS.include(calls.COMMANDS, lambda bridge, _: bridge.deeds.calls)
COMMANDS.include(goals.COMMANDS, lambda bridge, _: bridge.deeds.goals)
COMMANDS.include(goal_statuses.COMMANDS, lambda bridge, _: bridge.deeds.statuses)
COMMANDS.include(publishing.COMMANDS, lambda bridge, _: bridge.deeds.publishing)
COMMANDS.include(driving.COMMANDS, lambda bridge, _: bridge.driving)
COMMANDS.include(parameters.COMMANDS, lambda bridge, _: bridge.deeds.parameters)
COMMANDS.include(topics.COMMANDS, lambda bridge, _: bridge.topics)
COMMANDS.include(logs.COMMANDS, lambda bridge, _: bridge.logs)
COMMANDS.include(graph.COMMANDS, lambda bridge, _: bridge.graph)
COMMANDS.include(lifecycle.COMMANDS, lambda bridge, _: bridge.lifecycle)
COMMANDS.include(diagnostics.COMMANDS, lambda bridge, _: bridge.diagnostics)
COMMANDS.include(lessons.COMMANDS, lambda bridge, _: bridge.lessons)
