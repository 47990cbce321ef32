"""Those who hear what happens: one Listener per control lane, one Audience per document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from studio.engine.messages import Event
    from studio.engine.roles import Role


class Listener(Protocol):
    """The sending end of one control lane."""

    role: Role

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Queue one message without waiting; of one `key` only the newest need arrive."""
        ...


def encode(event: Event) -> bytes:
    """One event as the JSON text that goes to every listener."""
    return event.model_dump_json().encode()


def tell(listener: Listener, event: Event) -> None:
    """Send one event to one listener."""
    listener.post(encode(event))


class Audience:
    """All listeners of one thing; an event is encoded once for all of them."""

    def __init__(self) -> None:
        self._listeners: set[Listener] = set()

    def __len__(self) -> int:
        return len(self._listeners)

    def add(self, listener: Listener) -> None:
        """Let it hear what comes from now on."""
        self._listeners.add(listener)

    def remove(self, listener: Listener) -> None:
        """Forget it; it need not be there."""
        self._listeners.discard(listener)

    def tell(self, event: Event) -> None:
        """Send one event to all."""
        if self._listeners:
            self.post(encode(event))

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Send encoded bytes to all."""
        for listener in tuple(self._listeners):
            listener.post(data, binary=binary, key=key)
