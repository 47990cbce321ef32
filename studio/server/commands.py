"""One command from bytes to its answer: parsed at the door, allowed or not, carried out."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final

from pydantic import BaseModel, ValidationError

from studio.documents.engine import COMMANDS
from studio.errors import CommandError, StudioError
from studio.protocol.commands import COMMAND_LIMIT_BYTES
from studio.protocol.documents import Refused
from studio.protocol.listeners import tell
from studio.protocol.message import adapter_of, all_events, type_of
from studio.server.access import demand

if TYPE_CHECKING:
    from studio.protocol import Command, Event
    from studio.protocol.listeners import Listener
    from studio.protocol.roles import Visitor
    from studio.server.surface import OpenDocuments


COMMAND_ADAPTER: Final = adapter_of(COMMANDS.messages)
"""Parses every command."""
EVENT_ADAPTER: Final = adapter_of(all_events())
"""Parses every event."""
_REASON_LIMIT = 300
_LOG = logging.getLogger(__name__)


class _Numbered(BaseModel, extra="ignore"):
    """What can be read of a command that is malformed otherwise."""

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
    bytes_max = COMMANDS[type(command)].limits.bytes_max
    if len(text) > bytes_max:
        name = type_of(type(command)).replace("_", " ").capitalize()
        raise CommandError(f"{name} of more than {bytes_max} bytes is not taken.")
    return command


def malformed(what: str, error: ValidationError) -> str:
    """The first thing that is wrong, without repeating what was sent at length."""
    first = error.errors(include_url=False, include_context=False, include_input=False)[0]
    place = ".".join(str(step) for step in first["loc"]) or "its text"
    return f"The {what} is malformed at {place}: {first['msg']}"[:_REASON_LIMIT]


def request_of(text: bytes) -> int:
    """The request number of a command that could not be parsed, 0 when even that is missing."""
    if len(text) > COMMAND_LIMIT_BYTES:
        return 0
    try:
        return _Numbered.model_validate_json(text).request
    except ValidationError:
        return 0


async def answer(engine: OpenDocuments, listener: Listener, text: bytes) -> None:
    """Carry out one command; whatever is wrong with it becomes an answer."""
    try:
        command = parse_command(text)
        demand(listener, type_of(type(command)), command.document)
        await engine.execute(command, listener)
    except StudioError as error:
        tell(
            listener,
            Refused(request=request_of(text), kind=type(error).__name__, reason=str(error)),
        )
    except asyncio.CancelledError:
        if (task := asyncio.current_task()) is None or task.cancelling():
            raise
        # Not we were cancelled, but what we waited for: its document was closed.
        reason = "The document was closed before this was done: open it again."
        tell(listener, Refused(request=request_of(text), kind="ClosedError", reason=reason))
    except Exception:  # noqa: BLE001 - a bug of ours must not close the socket of a user
        _LOG.exception("A command failed")
        reason = "The studio failed at this command; its terminal says how."
        tell(listener, Refused(request=request_of(text), kind="InternalError", reason=reason))


class Answers:
    """The events that one command brought about, in their order; binary frames are left out."""

    def __init__(self, visitor: Visitor) -> None:
        self.role, self.person = visitor.role, visitor.person
        self.events: list[Event] = []

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
