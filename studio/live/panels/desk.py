"""BridgeDesk: carries out what panels ask of the ROS 2 system as a whole."""

from __future__ import annotations

import asyncio
from inspect import isawaitable
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypeVar

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
from studio.live.panels.reach import check_reach
from studio.live.panels.topics import TopicDesk
from studio.protocol import calls as k
from studio.protocol import goals as g
from studio.protocol import lessons as le
from studio.protocol import parameters as p
from studio.protocol import publishing as pub
from studio.protocol.diagnostics import GetDiagnostics
from studio.protocol.driving import Drive
from studio.protocol.graph import GetGraph, GetNode
from studio.protocol.interfaces import AddInterfaces, GetInterface, ListInterfaces
from studio.protocol.lifecycle import ChangeState, GetManaged
from studio.protocol.logs import GetLog
from studio.protocol.message import CommandMessage
from studio.protocol.topic_rates import GetTopicRates
from studio.protocol.topics import GetTopicEnds, ListTopics

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio import protocol as m
    from studio.live.connection.desk import WireDesk
    from studio.protocol.listeners import Listener

AnyCommand = TypeVar("AnyCommand", bound=CommandMessage)
Answer: TypeAlias = "m.BridgeEvent | None"
"""What the asker alone is told, if anything, before it is told that all is done."""
Work: TypeAlias = "Callable[[BridgeDesk, AnyCommand, Listener], Answer | Awaitable[Answer]]"


def _row(kind: type[AnyCommand], work: Work[AnyCommand]) -> tuple[type[CommandMessage], Work[Any]]:
    """A row of the table; here the two are seen to fit."""
    return kind, work


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

    async def carry_out(self, command: m.BridgeCommand, listener: Listener) -> m.BridgeEvent | None:
        """Carry out one command and give its answer, if it has one.

        Raises:
            StudioError: It cannot be done.
        """
        check_reach(command, self._wire.current)
        answer = WORK[type(command)](self, command, listener)
        return await answer if isawaitable(answer) else answer

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


_INTERFACES: Final = (
    _row(GetInterface, lambda d, c, _: d.interfaces.interface(c)),
    _row(ListInterfaces, lambda d, c, _: d.interfaces.names(c)),
    _row(AddInterfaces, lambda d, c, _: d.interfaces.add(c)),
)
_RATES: Final = (_row(GetTopicRates, lambda d, c, _: d.rates.rates(c)),)
_DEEDS: Final = (
    _row(k.GetServices, lambda d, c, _: d.deeds.offers.services(c)),
    _row(k.GetActions, lambda d, c, _: d.deeds.offers.actions(c)),
    _row(k.ReadValues, lambda d, c, _: d.deeds.offers.read(c)),
    _row(k.FollowDeeds, lambda d, c, who: d.deeds.follow(c, who)),
    _row(k.CallService, lambda d, c, _: d.deeds.calls.begin(c)),
    _row(k.CancelCall, lambda d, c, _: d.deeds.calls.cancel(c)),
    _row(g.SendGoal, lambda d, c, _: d.deeds.goals.begin(c)),
    _row(g.CancelGoal, lambda d, c, _: d.deeds.goals.cancel(c)),
    _row(g.GetGoalStatuses, lambda d, c, _: d.deeds.statuses.statuses(c)),
    _row(pub.Publish, lambda d, c, _: d.deeds.publishing.begin(c)),
    _row(pub.StopPublishing, lambda d, c, _: d.deeds.publishing.stop(c)),
    _row(Drive, lambda d, c, who: d.driving.drive(c, who)),
)
_PARAMETERS: Final = (
    _row(p.GetParameterNodes, lambda d, c, _: d.deeds.parameters.nodes(c)),
    _row(p.GetParameters, lambda d, c, _: d.deeds.parameters.parameters(c)),
    _row(p.SetParameter, lambda d, c, _: d.deeds.parameters.set(c)),
    _row(p.DumpParameters, lambda d, c, _: d.deeds.parameters.dump(c)),
    _row(p.LoadParameters, lambda d, c, _: d.deeds.parameters.load(c)),
    _row(p.FollowParameters, lambda d, c, who: d.deeds.parameters.follow(c, who)),
)
_TOPICS: Final = (
    _row(ListTopics, lambda d, c, _: d.topics.table(c)),
    _row(GetTopicEnds, lambda d, c, _: d.topics.ends(c)),
)
_LOGS: Final = (_row(GetLog, lambda d, c, _: d.logs.log(c)),)
_GRAPH: Final = (
    _row(GetGraph, lambda d, c, _: d.graph.graph(c)),
    _row(GetNode, lambda d, c, _: d.graph.node(c)),
    _row(GetManaged, lambda d, c, _: d.lifecycle.managed(c)),
    _row(ChangeState, lambda d, c, _: d.lifecycle.change(c)),
    _row(GetDiagnostics, lambda d, c, _: d.diagnostics.diagnostics(c)),
)
_LESSONS: Final = (
    _row(le.GetLessons, lambda d, c, _: d.lessons.lessons(c)),
    _row(le.GetDemos, lambda d, c, _: d.lessons.demos(c)),
    _row(le.GetDemoOutput, lambda d, c, _: d.lessons.output(c)),
    _row(le.GetDemoCode, lambda d, c, _: d.lessons.code(c)),
    _row(le.StartDemo, lambda d, c, _: d.lessons.start(c)),
    _row(le.StopDemo, lambda d, c, _: d.lessons.stop(c)),
    _row(le.PressKey, lambda d, c, _: d.lessons.press(c)),
)
_SEEN: Final = (*_GRAPH, *_LOGS, *_INTERFACES, *_RATES, *_TOPICS)
WORK: Final = dict((*_SEEN, *_DEEDS, *_PARAMETERS, *_LESSONS))
"""What each command of the bridge does."""
