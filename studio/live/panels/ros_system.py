"""RosSystem: all that panels see of a ROS 2 system, and do in it."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import TYPE_CHECKING, Final

from studio.errors import RouterGoneError
from studio.live.doctor.seen import Unanswered
from studio.live.panels import (
    calls,
    changes,
    diagnostics,
    doctor,
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
    recorded,
    recording,
    tool_publishing,
    topics,
)
from studio.live.time.recording_source import RecordingSource
from studio.live.topics.browsers import BrowserTopics
from studio.protocol.calls import FollowOperations
from studio.protocol.commands import Commands, Scope

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from pathlib import Path

    from studio.live.connection.ros_connection import RosConnection
    from studio.live.time.document_source import DocumentSource
    from studio.protocol.listeners import Listener


_STOP_S: Final = 3.0
"""So long an answer to a stop is waited for; what was begun goes on."""


class RosSystem:
    """One part for each subject of panels; used on the event loop only.

    Args:
        wire: The connection.
        bags: The folder in which topics are recorded.
    """

    def __init__(self, wire: RosConnection, bags: Path) -> None:
        self.connection = wire
        self.changes = changes.Changes()
        self._epoch = wire.topics.epoch
        wire.on_change = self._connection_changed
        self.interfaces = interfaces.InterfaceTypes(wire)
        self.source_of: Callable[[str], DocumentSource | None] = lambda _: None
        """The topics that an open document shows; None: it is not open."""
        self._recorded: dict[str, recorded.RecordedSystem] = {}
        """By document, while that shows a recording."""
        self.topics = topics.LiveTopics(wire)
        self.browser_topics = BrowserTopics(wire.topics)
        self.browser_topics.source_of = self._recording_of
        self.logs = logs.NodeLogs(wire.topics, lambda: self.changes.changed_elsewhere("log"))
        self.graph = graph.GraphViews(wire)
        self.lifecycle = lifecycle.LifecycleNodes(wire)
        elsewhere = self.changes.changed_elsewhere
        self.diagnostics = diagnostics.PartDiagnostics(
            wire.topics, partial(elsewhere, "diagnostics")
        )
        self.offers = offers.Offers(wire, self.interfaces)
        self.calls = calls.ServiceCalls(wire)
        self.goals = goals.ActionGoals(
            wire, self.logs, partial(self.changes.changed, "goal_statuses")
        )
        self.goal_statuses = goal_statuses.GoalStatusTopics(
            wire.topics,
            self.goals.own_ids,
            partial(elsewhere, "goal_statuses"),
            partial(self.changes.is_followed, "goal_statuses"),
        )
        self.publishing = publishing.Publishing(wire)
        self.tools = tool_publishing.ToolPublishing(wire, self.goals)
        self.parameters = parameters.NodeParameters(wire)
        self.parameters.recorded_for = lambda name: (
            one.parameters if (one := self.recorded_for(name)) else None
        )
        self.interfaces.recorded_for = lambda name: (
            one.types if (one := self._recording_of(name)) else None
        )
        self.driving = driving.Driving(wire)
        self.lessons = lessons.CourseDemos(wire, partial(self.changes.changed, "lessons"))
        self.doctor = doctor.Doctor(wire, self._unanswered)
        self.recording = recording.BagRecording(wire, bags)
        self.end_programs: Callable[[], Awaitable[None]] = _nothing
        """Ends what the owner runs, for it has joined the same system."""
        self._stopping: asyncio.Task[None] | None = None
        self._operations = {
            "calls": self.calls.operations,
            "goals": self.goals.operations,
            "publications": self.publishing.operations,
        }

    def _connection_changed(self) -> None:
        """Notify pages; with another connection, of all that they follow."""
        self.doctor.listen()
        if self._epoch == self.connection.topics.epoch:
            self.changes.changed("graph")
        else:
            self._epoch = self.connection.topics.epoch
            self.changes.all_changed()

    def _unanswered(self) -> tuple[Unanswered, ...]:
        """Return the services and actions whose last call or goal failed."""
        newest: dict[tuple[bool, str], tuple[str, str]] = {}
        for call in self.calls.operations.all():
            newest[False, call.name] = call.state, call.trouble
        for goal in self.goals.operations.all():
            newest[True, goal.name] = goal.state, goal.trouble
        return tuple(
            Unanswered(is_action, name, trouble)
            for (is_action, name), (state, trouble) in newest.items()
            if state == "failed"
        )

    def recorded_for(self, document: str) -> recorded.RecordedSystem | None:
        """Return the system of the recording that a document shows; None: it shows none."""
        source = self._recording_of(document)
        known = self._recorded.get(document)
        if known is not None and known.source is source:
            return known
        self._forget_recorded(document)
        if source is None:
            return None
        made = recorded.RecordedSystem(source, self.changes.changed_elsewhere)
        self._recorded[document] = made
        return made

    def time_switched(self, document: str) -> None:
        """A document shows another time: what its pages follow is another's."""
        self._forget_recorded(document)
        self.browser_topics.switch(document)
        self.changes.all_changed()

    def moment_changed(self, document: str) -> None:
        """A document shows another moment of its recording."""
        if document in self._recorded:
            self.changes.changed("log")
            self.changes.changed("diagnostics")

    def _forget_recorded(self, document: str) -> None:
        if (known := self._recorded.pop(document, None)) is not None:
            known.close()

    def _recording_of(self, document: str) -> RecordingSource | None:
        source = self.source_of(document) if document else None
        current = None if source is None else source.current
        return current if isinstance(current, RecordingSource) else None

    def check_router(self) -> None:
        """Pass if the router is there, or if there is no connection yet: one is made then.

        Raises:
            RouterGoneError: The router is away.
        """
        link = self.connection.current
        if link is not None and not link.is_connected:
            raise RouterGoneError(link.endpoint)

    def follow(self, command: FollowOperations, listener: Listener) -> None:
        """Send a page the operations of one kind from now on, or no longer."""
        operations = self._operations[command.operations]
        if command.following:
            operations.follow(listener)
        else:
            operations.unfollow(listener)

    def attach(self, listener: Listener) -> None:
        """A page is there."""
        self.publishing.attach(listener)
        self.recording.attach(listener)

    def detach(self, listener: Listener) -> None:
        """Remove a page: what it drove stops, and what it began goes on.

        Only what is published again and again ends when no page is left that could stop it.
        """
        for operations in self._operations.values():
            operations.unfollow(listener)
        self.parameters.detach(listener)
        self.changes.detach(listener)
        self.publishing.detach(listener)
        self.recording.detach(listener)
        self.driving.detach(listener)

    def release(self, may_go_on: Callable[[str], bool]) -> None:
        """End what persons drive and publish who have no control; calls and goals go on."""
        self.driving.release(may_go_on)
        self.publishing.release(may_go_on)
        self.tools.release(may_go_on)

    async def stop(self) -> None:
        """Stop all that pages make robots do: publish zero, cancel goals, end publications.

        Who asks while one is under way waits for that.
        """
        if self._stopping is None or self._stopping.done():
            self._stopping = asyncio.create_task(self._stop())
        await asyncio.shield(self._stopping)

    async def _stop(self) -> None:
        published = self.publishing.stop_all()
        self.tools.release(lambda _: False)
        stops = (self.driving.stop(published), self.goals.cancel_all())
        # A server that does not answer, or a router that is away, keeps nobody waiting.
        await asyncio.wait([asyncio.create_task(one) for one in stops], timeout=_STOP_S)

    async def let_go(self) -> None:
        """Let go of the connection, which is about to end."""
        await asyncio.gather(
            self.recording.close(),
            self.let_go_of_operations(),
            self.doctor.let_go(),
            self.driving.let_go(),
            self.lessons.let_go(),
            self.lifecycle.let_go(),
            self.end_programs(),
        )

    async def let_go_of_operations(self) -> None:
        """End calls, goals and publications; returns when all have ended."""
        self.goal_statuses.let_go()
        await asyncio.gather(
            self.calls.let_go(),
            self.goals.let_go(),
            self.publishing.let_go(),
            self.parameters.let_go(),
            self.tools.let_go(),
        )

    async def close(self) -> None:
        """End all that runs."""
        await asyncio.gather(
            self.recording.close(),
            self.changes.close(),
            self.browser_topics.close(),
            self.let_go_of_operations(),
            self.driving.let_go(),
            self.lessons.close(),
            self.lifecycle.let_go(),
        )
        parts = (self.calls, self.goals, self.publishing, self.parameters, self.doctor)
        await asyncio.gather(*(one.close() for one in parts))


async def _nothing() -> None:
    return


COMMANDS: Final = Commands[RosSystem](Scope.ROS)
COMMANDS.viewer(FollowOperations, lambda ros, c, who: ros.follow(c, who))
COMMANDS.include(calls.COMMANDS, lambda ros, _: ros.calls)
COMMANDS.include(changes.COMMANDS, lambda ros, _: ros.changes)
COMMANDS.include(
    diagnostics.COMMANDS, lambda ros, c: (ros.recorded_for(c.document) or ros).diagnostics
)
COMMANDS.include(doctor.COMMANDS, lambda ros, _: ros.doctor)
COMMANDS.include(driving.COMMANDS, lambda ros, _: ros.driving)
COMMANDS.include(goal_statuses.COMMANDS, lambda ros, _: ros.goal_statuses)
COMMANDS.include(goals.COMMANDS, lambda ros, _: ros.goals)
COMMANDS.include(graph.COMMANDS, lambda ros, c: (ros.recorded_for(c.document) or ros).graph)
COMMANDS.include(interfaces.COMMANDS, lambda ros, _: ros.interfaces)
COMMANDS.include(lessons.COMMANDS, lambda ros, _: ros.lessons)
COMMANDS.include(lifecycle.COMMANDS, lambda ros, _: ros.lifecycle)
COMMANDS.include(logs.COMMANDS, lambda ros, c: (ros.recorded_for(c.document) or ros).logs)
COMMANDS.include(offers.COMMANDS, lambda ros, _: ros.offers)
COMMANDS.include(parameters.COMMANDS, lambda ros, _: ros.parameters)
COMMANDS.include(publishing.COMMANDS, lambda ros, _: ros.publishing)
COMMANDS.include(
    rates.COMMANDS,
    lambda ros, c: one.source if (one := ros.recorded_for(c.document)) else ros.connection.topics,
)
COMMANDS.include(recording.COMMANDS, lambda ros, _: ros.recording)
COMMANDS.include(topics.COMMANDS, lambda ros, c: ros.recorded_for(c.document) or ros.topics)
