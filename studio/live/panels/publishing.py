"""Messages that pages publish: once, or at a rate while a page is there that could stop it."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.errors import CommandError
from studio.live.panels.operations import Begins, Operations, Outcome, RunningTasks
from studio.protocol.calls import Begun
from studio.protocol.commands import Commands, Scope
from studio.protocol.publishing import Publications, PublicationView, Publish, StopPublishing
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.ros_connection import RosConnection
    from studio.live.panels.publication_work import MessageSender
    from studio.protocol.listeners import Listener

_KEPT: Final = 20
_RUNNING_MAX: Final = 20
_LISTENER_PATIENCE_S: Final = 1.0
"""So long a single publication waits for a subscriber."""
_STAY_S: Final = 0.2
"""After a single publication, before the publisher closes."""
_CHECK_EVERY_S: Final = 0.5
_GRACE_S: Final = 3.0
"""A page that is loaded again is back within this time."""

_TWIST: Final = "geometry_msgs/msg/Twist"
_TWIST_STAMPED: Final = "geometry_msgs/msg/TwistStamped"
_State: TypeAlias = Literal["running", "done", "stopped", "failed"]
_STATES: Final[dict[str, _State]] = {"done": "done", "failed": "failed", "cancelled": "stopped"}


_AS_ASKED: Final = {"text", "rate_hz", "reliable", "latched", "depth"}
_OWN: Final = tuple(name for name in PublicationView.model_fields if name not in _AS_ASKED)


@dataclass
class Publication:
    """What is published, and how often so far; counted in the connection's thread."""

    operation: int
    name: str
    message_type: str
    asked: Publish
    person: str = ""
    """Who began it."""
    state: _State = "running"
    sent: int = 0
    listeners: int = 0
    began_s: float = field(default_factory=lambda: time.time_ns() / 1e9)
    trouble: str = ""

    @property
    def is_over(self) -> bool:
        """Whether it is published no more."""
        return self.state != "running"

    def count_one(self) -> None:
        """Count one message."""
        self.sent += 1

    def view(self) -> PublicationView:
        """Return the publication as the page receives it."""
        own = {name: getattr(self, name) for name in _OWN}
        return PublicationView(**own, **self.asked.model_dump(include=_AS_ASKED))


def _event_of(is_whole: bool, found: tuple[Publication, ...]) -> Publications:  # noqa: FBT001
    return Publications(whole=is_whole, operations=tuple(one.view() for one in found))


class Publishing:
    """Begins and ends publications; `operations` has their state."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self.operations: Operations[Publication] = Operations(
            _event_of, kept=_KEPT, running=_RUNNING_MAX
        )
        self._running, self._begins = RunningTasks(), Begins()
        self._presenters: set[Listener] = set()
        self._leaving: asyncio.TimerHandle | None = None

    async def begin(self, command: Publish, person: str = "") -> Begun:
        """Publish, and do not wait for it.

        Raises:
            StudioError: It cannot be published.
        """
        from studio.live.panels.publication_work import MessageSender  # noqa: PLC0415 - imports zenoh

        number = self.operations.next_number()
        with self._begins.of(person) as begin:
            link = await self._wire.link()
            sender = await asyncio.to_thread(MessageSender, link, command)
            if not begin.may_go_on:
                await asyncio.to_thread(sender.close)
                raise CommandError("The robot was stopped, or control went to somebody else.")
        publication = Publication(number, sender.name, sender.type_name, command, person)
        self.operations.add(publication)
        self._running.start(
            number,
            self._run(publication, sender),
            lambda outcome: self._finish(publication, sender, outcome),
        )
        return Begun(request=command.request, operation=number)

    def stop(self, command: StopPublishing) -> None:
        """Stop publishing it.

        Raises:
            CommandError: There is no such publication.
        """
        if command.operation:
            self.operations.get(command.operation)
            self._running.cancel(command.operation)
        else:
            self._stop_all("")

    def release(self, may_go_on: Callable[[str], bool]) -> None:
        """Stop what persons publish who have no control any more."""
        self._begins.release(may_go_on)
        for one in self.operations.unfinished():
            if not may_go_on(one.person):
                self._running.cancel(one.operation, "Control went to somebody else.")

    def stop_all(self) -> dict[str, bool]:
        """Stop all; return the topics of velocities that were published, and if it was stamped."""
        self._begins.release(lambda _: False)
        self._stop_all("")
        kinds = {_TWIST: False, _TWIST_STAMPED: True}
        every = self.operations.all()
        return {one.name: kinds[one.message_type] for one in every if one.message_type in kinds}

    def attach(self, listener: Listener) -> None:
        """Add a page, which may stop what runs."""
        if listener.role is Role.PRESENTER:
            self._presenters.add(listener)

    def detach(self, listener: Listener) -> None:
        """Remove a page; when nobody is left who could stop it, what runs ends in a moment."""
        was_there = listener in self._presenters
        self._presenters.discard(listener)
        if was_there and not self._presenters and self.operations.unfinished():
            if self._leaving is not None:
                self._leaving.cancel()
            self._leaving = asyncio.get_running_loop().call_later(_GRACE_S, self._left)

    async def let_go(self) -> None:
        """End all: the connection is about to."""
        await self._running.end_all("The connection with ROS 2 was ended.")

    async def close(self) -> None:
        """End all that runs, and send no more events."""
        if self._leaving is not None:
            self._leaving.cancel()
        await self.let_go()
        await self.operations.close()

    def _left(self) -> None:
        self._leaving = None
        if not self._presenters:
            self._stop_all("The last page that could stop it was closed.")

    def _stop_all(self, reason: str) -> None:
        for one in self.operations.unfinished():
            self._running.cancel(one.operation, reason)

    async def _run(self, publication: Publication, sender: MessageSender) -> None:
        from studio.live.panels.requests import came_true  # noqa: PLC0415 - imports zenoh

        rate_hz = publication.asked.rate_hz
        if rate_hz > 0:
            await asyncio.to_thread(sender.repeat, rate_hz, publication.count_one)
            while True:
                publication.listeners = sender.listeners()
                self.operations.changed(publication)
                await asyncio.sleep(_CHECK_EVERY_S)
        await came_true(lambda: sender.listeners() > 0, _LISTENER_PATIENCE_S)
        publication.listeners = sender.listeners()
        await asyncio.to_thread(sender.send)
        publication.count_one()
        self.operations.changed(publication)
        await asyncio.sleep(_STAY_S)

    async def _finish(
        self, publication: Publication, sender: MessageSender, outcome: Outcome[None]
    ) -> None:
        await asyncio.to_thread(sender.close)
        publication.state, publication.trouble = _STATES[outcome.kind], outcome.trouble
        self.operations.changed(publication)


COMMANDS: Final = Commands[Publishing](Scope.ROS)
COMMANDS.controller(Publish, lambda one, c, who: one.begin(c, who.person), needs_router=True)
COMMANDS.controller(StopPublishing, lambda one, c, _: one.stop(c))
