"""Questions that many pages ask at once, as after each change: asked once for all of a relay."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

import msgspec

from studio.documents.engine import COMMANDS
from studio.protocol.roles import Role, owner_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.protocol import Command
    from studio.protocol.listeners import Listener

_Event: TypeAlias = dict[str, msgspec.Raw]
"""Its fields as they came: they may be long, and go to many."""
_DECODER: Final = msgspec.json.Decoder(_Event)
_NO_NUMBER: Final = msgspec.Raw(b"")
_FRESH_S: Final = 1.0
_KEPT_MAX: Final = 256


def is_shared(command: Command, listener: Listener) -> bool:
    """Whether the answer to others serves this page as well."""
    shared = COMMANDS[type(command)].same_for_all and not owner_of(command.document)
    return shared and listener.role in {Role.GUEST, Role.STUDENT}


class _Reader:
    """A Listener that keeps what answers a command, for all who asked.

    What else it is sent is for the person who asked first: who they are, what they control.
    """

    def __init__(self, first: Listener, request: int) -> None:
        self._first, self._request = first, str(request).encode()
        self.role, self.person = first.role, first.person
        self.events: list[_Event] = []

    def sees(self, document: str) -> bool:
        """Whether who asked first may look at a document."""
        return self._first.sees(document)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Keep one event, if it is of the answer."""
        del key
        if not binary:
            event = _DECODER.decode(data)
            if bytes(event.get("request", _NO_NUMBER)) == self._request:
                self.events.append(event)


class _Read(NamedTuple):
    version: int
    since_s: float
    events: asyncio.Future[list[_Event]]


class SharedReads:
    """Used on the event loop only.

    Args:
        ask: Asks the origin, and returns once it has answered to the listener.
        forget: Forgets a listener that asked.
        version: Counts what the origin has told: no answer is older than what a page was told.
    """

    def __init__(
        self,
        ask: Callable[[Command, Listener], Awaitable[None]],
        forget: Callable[[Listener], object],
        version: Callable[[], int],
    ) -> None:
        self._ask, self._forget, self._version = ask, forget, version
        self._reads: dict[str, _Read] = {}

    async def answer(self, command: Command, listener: Listener) -> None:
        """Answer from what others were answered just now, or ask.

        Raises:
            StudioError: The origin is away.
        """
        key = listener.role + command.model_dump_json(exclude={"request", "id"})
        now_s = asyncio.get_running_loop().time()
        found = self._reads.get(key)
        if found is None or found.version != self._version() or now_s - found.since_s > _FRESH_S:
            events = asyncio.ensure_future(self._asked(command, listener))
            events.add_done_callback(_noticed)
            self._reads = {
                one: read
                for one, read in self._reads.items()
                if one != key and now_s - read.since_s <= _FRESH_S
            }
            found = self._reads[key] = _Read(self._version(), now_s, events)
            while len(self._reads) > _KEPT_MAX:
                del self._reads[next(iter(self._reads))]
        own = msgspec.Raw(str(command.request).encode())
        for event in await asyncio.shield(found.events):
            listener.post(msgspec.json.encode({**event, "request": own}))

    async def _asked(self, command: Command, first: Listener) -> list[_Event]:
        reader = _Reader(first, command.request)
        try:
            await self._ask(command, reader)
        finally:
            self._forget(reader)
        return reader.events


def _noticed(events: asyncio.Future[list[_Event]]) -> None:
    """Look at a failure, for who asked may have left."""
    if not events.cancelled():
        events.exception()
