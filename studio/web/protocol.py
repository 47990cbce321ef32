"""uvicorn's websocket protocol, showing its transport: one write of shared bytes to many."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.protocol import State

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import Scope
    from websockets.http11 import Request

_EXTENSION = "studio.socket"
_TEXT, _BINARY = 0x81, 0x82  # final frame of a text or a binary message
_SHORT, _MEDIUM = 125, 0xFFFF


class StudioSocket(WebSocketsSansIOProtocol):
    """A websocket whose frames may be written past ASGI, without waiting, by any number of bytes.

    ASGI's `send` waits for the transport and frames the bytes once per client; a frame from server
    to client is not masked, so one encoded frame serves all.
    """

    on_drain: Callable[[], object] | None = None
    """Called when a full write buffer has emptied."""

    def handle_connect(self, event: Request) -> None:
        """Let the application find its socket: the task that runs it has not begun yet."""
        super().handle_connect(event)
        if self.conn.state is State.CONNECTING and not self.close_sent:
            self.scope["extensions"][_EXTENSION] = {"protocol": self}  # type: ignore[typeddict-item]

    def resume_writing(self) -> None:
        """Pass on that there is room again."""
        super().resume_writing()
        if self.on_drain is not None:
            self.on_drain()

    def keepalive_timeout(self) -> None:
        """End a socket of which the other side answers no ping: it sleeps, or is gone unsaid."""
        super().keepalive_timeout()
        self.transport.abort()  # an orderly end waits until all is sent, maybe for ever

    def give_up_within(self, time_s: float) -> None:
        """End it then, if it is not closed by itself: its other side may never take the rest."""
        self.loop.call_later(time_s, self.transport.abort)

    def write_frame(self, frame: bytes) -> None:
        """Write one whole frame; nothing happens when the socket is no longer open."""
        if self.conn.state is State.OPEN and not self.transport.is_closing():
            self.transport.write(frame)

    def pending_bytes(self) -> int:
        """Bytes written and not yet taken by the system."""
        return self.transport.get_write_buffer_size()


def socket_of(scope: Scope) -> StudioSocket:
    """The protocol that serves this websocket."""
    extension = cast("dict[str, StudioSocket]", scope["extensions"][_EXTENSION])
    return extension["protocol"]


class Framer:
    """Frames messages; of a message sent to many in a row the frame is made once."""

    def __init__(self) -> None:
        self._payload: bytes | None = None
        self._binary = False
        self._frame = b""

    def frame(self, payload: bytes, *, binary: bool) -> bytes:
        """The frame of one whole message, unmasked."""
        if payload is not self._payload or binary is not self._binary:
            self._frame = _head(len(payload), binary=binary) + payload
            self._payload, self._binary = payload, binary
        return self._frame


def _head(length: int, *, binary: bool) -> bytes:
    """First bytes of a frame (RFC 6455 section 5.2)."""
    first = _BINARY if binary else _TEXT
    if length <= _SHORT:
        return bytes((first, length))
    if length <= _MEDIUM:
        return bytes((first, 126)) + length.to_bytes(2, "big")
    return bytes((first, 127)) + length.to_bytes(8, "big")
