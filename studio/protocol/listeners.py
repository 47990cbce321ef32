"""Receivers of events: one Listener per control lane, one Audience per document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

if TYPE_CHECKING:
    from studio.protocol import Event
    from studio.protocol.roles import Role

_Sent = TypeVar("_Sent", bound="Event")


class Listener(Protocol):
    """The sending end of one control lane, and whose it is."""

    @property
    def role(self) -> Role:
        """Of its person; it may become another one meanwhile."""
        ...

    @property
    def person(self) -> str:
        """The same for all that comes from one browser, or with one token."""
        ...

    def sees(self, document: str) -> bool:
        """Whether its person may look at a document."""
        ...

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Queue one message without waiting; of one `key` only the newest need arrive."""
        ...


def encode(event: Event) -> bytes:
    """Return an event as the JSON text that every listener receives."""
    return event.model_dump_json().encode()


def send(listener: Listener, event: Event) -> None:
    """Send one event to one listener."""
    listener.post(encode(event))


class Audience:
    """All listeners of one thing; an event is encoded once for all of them."""

    def __init__(self) -> None:
        self._listeners: set[Listener] = set()

    def __len__(self) -> int:
        return len(self._listeners)

    def __contains__(self, listener: Listener) -> bool:
        return listener in self._listeners

    def add(self, listener: Listener) -> None:
        """Send it every event from now on."""
        self._listeners.add(listener)

    def remove(self, listener: Listener) -> None:
        """Forget it; it need not be there."""
        self._listeners.discard(listener)

    def send(self, event: Event) -> None:
        """Send one event to all."""
        if self._listeners:
            self.post(encode(event))

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Send encoded bytes to all."""
        for listener in tuple(self._listeners):
            listener.post(data, binary=binary, key=key)


class LastSent(Generic[_Sent]):
    """The event that an audience was sent last, so that only changes are sent.

    Attributes:
        event: None before the first.
    """

    def __init__(self, audience: Audience) -> None:
        self._audience = audience
        self.event: _Sent | None = None

    def send(self, event: _Sent) -> None:
        """Send the event, unless it equals the last one."""
        if event != self.event:
            self.event = event
            self._audience.send(event)
