"""A listener for one request: it keeps what the engine says, for an answer in one piece."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.server.commands import answer
from studio.server.schema import EVENT_ADAPTER

if TYPE_CHECKING:
    from studio.protocol import Event
    from studio.protocol.roles import Visitor
    from studio.server.surface import OpenDocuments


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
