"""Commands of browsers: the control lane that they come on, and each from bytes to its answer."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final, Protocol

from pydantic import BaseModel, ValidationError

from studio.documents.engine import COMMANDS
from studio.errors import CommandError, StudioError
from studio.outlet import Outlet
from studio.protocol.commands import COMMAND_LIMIT_BYTES, demand
from studio.protocol.documents import Refused
from studio.protocol.listeners import Listener, send
from studio.protocol.message import adapter_of, all_events
from studio.protocol.roles import Person
from studio.server.websocket import FrameTransport, binary_frame, text_frame

if TYPE_CHECKING:
    from studio.protocol import Command, Event
    from studio.protocol.documents import Hello
    from studio.protocol.roles import Role
    from studio.server.surface import OpenDocuments
    from studio.server.websocket import Lane


COMMAND_ADAPTER: Final = adapter_of(COMMANDS.messages)
"""Parses every command."""
EVENT_ADAPTER: Final = adapter_of(all_events())
"""Parses every event."""
_REASON_LIMIT = 300
_LOG = logging.getLogger(__name__)


class _Numbered(BaseModel, extra="ignore"):
    """The readable part of a command that is malformed otherwise."""

    request: int = 0


def parse_command(text: bytes) -> Command:
    """Read one command.

    Raises:
        CommandError: It is none of the union's, or too long.
    """
    if len(text) > COMMAND_LIMIT_BYTES:
        raise CommandError(f"A command of more than {COMMAND_LIMIT_BYTES} bytes is not read.")
    try:
        command = COMMAND_ADAPTER.validate_json(text)
    except ValidationError as error:
        raise CommandError(malformed("command", error)) from None
    entry = COMMANDS[type(command)]
    bytes_max = entry.limits.bytes_max
    if len(text) > bytes_max:
        name = entry.permission.name.replace("_", " ").capitalize()
        raise CommandError(f"{name} of more than {bytes_max} bytes is not taken.")
    return command


def malformed(what: str, error: ValidationError) -> str:
    """Return the first thing that is wrong, without repeating what was sent at length."""
    first = error.errors(include_url=False, include_context=False, include_input=False)[0]
    place = ".".join(str(step) for step in first["loc"]) or "its text"
    return f"The {what} is malformed at {place}: {first['msg']}"[:_REASON_LIMIT]


def request_of(text: bytes) -> int:
    """Return the request number of a command that could not be parsed, 0 without any."""
    if len(text) > COMMAND_LIMIT_BYTES:
        return 0
    try:
        return _Numbered.model_validate_json(text).request
    except ValidationError:
        return 0


class Asker(Listener, Person, Protocol):
    """Where the answers go, and who asks."""


async def answer(engine: OpenDocuments, listener: Asker, text: bytes) -> None:
    """Carry out one command; whatever is wrong with it becomes an answer."""
    try:
        command = parse_command(text)
        demand(listener, COMMANDS[type(command)].permission, command.document)
        await engine.execute(command, listener)
    except StudioError as error:
        send(
            listener,
            Refused(request=request_of(text), kind=type(error).__name__, reason=str(error)),
        )
    except asyncio.CancelledError:
        if (task := asyncio.current_task()) is None or task.cancelling():
            raise
        # Not we were cancelled, but what we waited for: its document was closed.
        reason = "The document was closed before this was done: open it again."
        send(listener, Refused(request=request_of(text), kind="ClosedError", reason=reason))
    except Exception:  # noqa: BLE001 - a bug of ours must not close the socket of a user
        _LOG.exception("A command failed")
        reason = "The studio failed at this command; its terminal says how."
        send(listener, Refused(request=request_of(text), kind="InternalError", reason=reason))


class Answers:
    """The events that one command brought about, in their order; binary frames are left out."""

    def __init__(self, visitor: Person) -> None:
        self._visitor = visitor
        self.person = visitor.person
        self.events: list[Event] = []

    @property
    def role(self) -> Role:
        """The role of who asks, now."""
        return self._visitor.role

    def controls(self, document: str) -> bool:
        """Whether who asks has control."""
        return self._visitor.controls(document)

    def sees(self, document: str) -> bool:
        """Whether who asks may look at a document."""
        return self._visitor.sees(document)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Keep one event."""
        del key
        if not binary:
            self.events.append(EVENT_ADAPTER.validate_json(data))

    async def collect(self, engine: OpenDocuments, text: bytes) -> list[Event]:
        """Carry out one command and give what came of it."""
        try:
            await answer(engine, self, text)
        finally:
            engine.detach(self)
        return self.events


_RUNNING_LIMIT: Final = 64
"""Commands of one browser that may wait for the engine; then its socket is not read."""
_TOO_SLOW: Final = 1013
"""Close code `try again later`: the page connects again and gets the whole state."""


class ControlLane:
    """One browser's control lane: the Listener that the engine posts to."""

    def __init__(self, lane: Lane, visitor: Person) -> None:
        self._visitor = visitor
        self.person = visitor.person
        self._lane = lane
        self._outlet = Outlet(FrameTransport(lane), on_hopeless=lambda: lane.close(_TOO_SLOW))
        lane.on_drain(self._outlet.resume)

    @property
    def role(self) -> Role:
        """The role of its person, now."""
        return self._visitor.role

    def controls(self, document: str) -> bool:
        """Whether its person has control."""
        return self._visitor.controls(document)

    def sees(self, document: str) -> bool:
        """Whether its person may look at a document."""
        return self._visitor.sees(document)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Queue one message without waiting; of one `key` only the newest need arrive."""
        self._outlet.post(binary_frame(data) if binary else text_frame(data), key)

    async def serve(self, engine: OpenDocuments, hello: Hello) -> None:
        """Greet, then answer commands until the browser leaves.

        Commands start in their order but do not wait for each other: a slow one stops no slider.
        What runs when the browser leaves is finished; a save is not given up half-way.
        """
        self.post(hello.model_dump_json().encode())
        engine.attach(self)
        try:
            async with asyncio.TaskGroup() as group:
                running = await self._answer_all(engine, group)
                if self._lane.server_ends:  # the engine has ended before: nothing can come of it
                    for task in running:
                        task.cancel()
        finally:
            engine.detach(self)
            self._outlet.close()
            await self._lane.finish()

    async def _answer_all(
        self, engine: OpenDocuments, group: asyncio.TaskGroup
    ) -> set[asyncio.Task[None]]:
        """Start every command that comes; gives those that are not done when the lane ends."""
        running: set[asyncio.Task[None]] = set()
        while (text := await self._lane.receive()) is not None:
            task = group.create_task(answer(engine, self, text))
            running.add(task)
            task.add_done_callback(running.discard)
            while len(running) >= _RUNNING_LIMIT:
                await asyncio.wait(running, return_when=asyncio.FIRST_COMPLETED)
        return running
