"""A browser's websocket: bounded in what it may send, and written to without waiting.

What comes is parsed in small pieces, each of which is counted: a flood of tiny frames neither
stalls the loop nor fills the memory, but is read as slowly as its sender may send.
"""

from __future__ import annotations

import asyncio
import contextlib
import socket
from typing import TYPE_CHECKING, Any, Final, cast

from starlette.websockets import WebSocketDisconnect, WebSocketState
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import CloseCode
from websockets.protocol import State

from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import Scope
    from starlette.websockets import WebSocket
    from uvicorn._types import ASGIReceiveEvent, ASGISendEvent
    from uvicorn.config import Config
    from uvicorn.server import ServerState
    from websockets.frames import Frame
    from websockets.http11 import Request

    from studio.protocol.roles import Person
    from studio.server.crowd import CrowdedState


VIEWER_MESSAGE_LIMIT_BYTES: Final = 64 << 10
"""For guests, who send little; the limit of all others is that of a command."""
_EXTENSION = "studio.socket"
_PIECE_BYTES: Final = 4 << 10
_UNIT_BYTES: Final = 1 << 10
_FRAGMENTS_MAX: Final = 1_024
"""Limit for one message; a browser sends one megabyte in a few dozen."""
_TURN_UNITS: Final = 256
"""Frames, or KiB, that are parsed before others have their turn: some milliseconds."""
_UNSENT_BYTES: Final = 16 << 10
_PONGS_PENDING_BYTES: Final = 64 << 10
"""Limit for a client that pings and reads no answer."""
_TEXT, _BINARY = 0x81, 0x82  # final frame of a text or a binary message
_SHORT, _MEDIUM = 125, 0xFFFF


class StudioSocket(WebSocketsSansIOProtocol):
    """A websocket whose frames may be written past ASGI, without waiting, by any number of bytes.

    ASGI's `send` waits for the transport and frames the bytes once per client; a frame from server
    to client is not masked, so one encoded frame serves all.
    """

    on_drain: Callable[[], object] | None = None
    """Called when a full write buffer has emptied."""

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self._crowd = cast("CrowdedState", server_state).crowd
        self._held = bytearray()
        """Bytes received and not parsed yet; nothing more is read meanwhile."""
        self._rest: asyncio.TimerHandle | None = None
        self._frame_count = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Count the new connection as a stranger's."""
        super().connection_made(transport)
        hold_little(transport)
        self._crowd.arrive(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Remove the connection from the crowd, and forget what was held."""
        self._crowd.leave(self)
        self._held.clear()
        if self._rest is not None:
            self._rest.cancel()
        super().connection_lost(exc)

    def recognise(self, visitor: Person | None) -> bool:
        """Assign the websocket to a person; False when they have too many."""
        if visitor is None:
            return True
        if visitor.role is Role.GUEST:  # others may come to have control
            self.conn.max_message_size = VIEWER_MESSAGE_LIMIT_BYTES
        return self._crowd.recognise(self, visitor)

    def data_received(self, data: bytes) -> None:
        """Parse what came, or hold it until it may be parsed."""
        self._held += data
        self._read_on()

    def handle_events(self) -> None:
        """Count the frames, and hand them on."""
        self._frame_count += len(self.conn.events)
        super().handle_events()

    def handle_connect(self, event: Request) -> None:
        """Let the application find its socket: the task that runs it has not begun yet."""
        super().handle_connect(event)
        if self.conn.state is State.CONNECTING and not self.close_sent:
            self.scope["extensions"][_EXTENSION] = {"protocol": self}  # type: ignore[typeddict-item]

    def handle_cont(self, event: Frame) -> None:
        """Take in one more fragment of a message."""
        if len(self.frames) >= _FRAGMENTS_MAX:
            self._fail(CloseCode.MESSAGE_TOO_BIG, "too many fragments")
        elif not self.close_sent:
            super().handle_cont(event)

    def handle_ping(self) -> None:
        """Answer, unless the answers before are not taken."""
        if self.pending_bytes() > _PONGS_PENDING_BYTES:
            self.conn.data_to_send()
        else:
            super().handle_ping()

    def send_receive_event_to_app(self) -> None:
        """Pass a whole message on; invalid UTF-8 in a text message ends the websocket."""
        if self.curr_msg_data_type == "text":
            whole = b"".join(self.frames)
            try:
                whole.decode()
            except UnicodeDecodeError:
                self._fail(CloseCode.INVALID_DATA, "invalid UTF-8")
                return
            self.frames = [whole]
        super().send_receive_event_to_app()

    def handle_parser_exception(self) -> None:
        """End what is no websocket; uvicorn expects that a closing frame was sent."""
        if self.conn.close_sent is None:
            self.transport.abort()
        else:
            super().handle_parser_exception()

    async def receive(self) -> ASGIReceiveEvent:
        """Return the next event; what was held while the application was busy is parsed then."""
        event = await super().receive()
        if self._held or self._rest is not None:
            self._read_on()
        return event

    async def send(self, message: ASGISendEvent) -> None:
        """Send what the application sends; after the handshake, parse what was received before."""
        await super().send(message)
        if self.close_sent:
            self.handshake_complete = True  # by a refusal, too: uvicorn would miss an answer
        if self._held:
            self._read_on()

    def _read_on(self) -> None:
        """Parse piece by piece, as far and as fast as it may be."""
        turn_units = 0.0
        while self._held and self._may_parse():
            piece = bytes(self._held[:_PIECE_BYTES])
            del self._held[:_PIECE_BYTES]
            self._frame_count = 0
            super().data_received(piece)
            units = self._frame_count + len(piece) / _UNIT_BYTES
            turn_units += units
            pause_s = self._crowd.spend(self, units)
            if pause_s > 0 or turn_units > _TURN_UNITS:
                self._rest = self.loop.call_later(pause_s, self._rested)
        if self.conn.handshake_exc is not None:
            self._crowd.refuse("its websocket handshake is none")
            self.transport.abort()
        elif self._held or self._rest is not None:
            self.transport.pause_reading()
        elif not self.read_paused:
            self.transport.resume_reading()

    def _may_parse(self) -> bool:
        if self._rest is not None or self.read_paused or self.transport.is_closing():
            return False
        return self.handshake_complete or not self.handshake_initiated

    def _rested(self) -> None:
        self._rest = None
        self._read_on()

    def _fail(self, code: CloseCode, reason: str) -> None:
        if not self.close_sent:
            self.conn.fail(code, reason)
            self.handle_parser_exception()

    def resume_writing(self) -> None:
        """Pass on that there is room again."""
        super().resume_writing()
        if self.on_drain is not None:
            self.on_drain()

    def keepalive_timeout(self) -> None:
        """End a socket of which the other side answers no ping: it sleeps, or is gone unsaid."""
        super().keepalive_timeout()
        self.transport.abort()  # an orderly end waits until all is sent, maybe for ever

    def abort(self) -> None:
        """End it at once, with what was not taken yet."""
        self.transport.abort()

    def give_up_within(self, time_s: float) -> None:
        """End it then, if it is not closed by itself: its other side may never take the rest."""
        self.loop.call_later(time_s, self.transport.abort)

    def write_frame(self, frame: bytes) -> None:
        """Write one whole frame; nothing happens when the socket is no longer open."""
        if self.conn.state is State.OPEN and not self.transport.is_closing():
            self.transport.write(frame)
            self._crowd.sent_bytes += len(frame)

    def pending_bytes(self) -> int:
        """Bytes written and not yet taken by the system."""
        return self.transport.get_write_buffer_size()


def hold_little(transport: asyncio.BaseTransport) -> None:
    """Have the system take little before it can be sent.

    What waits with us is replaced by what is newer; what waits there arrives late.
    """
    connection: socket.socket | None = transport.get_extra_info("socket")
    option: int | None = getattr(socket, "TCP_NOTSENT_LOWAT", None)
    if connection is not None and option is not None:
        with contextlib.suppress(OSError):
            connection.setsockopt(socket.IPPROTO_TCP, option, _UNSENT_BYTES)


def socket_of(scope: Scope) -> StudioSocket:
    """Return the protocol that serves this websocket."""
    extension = cast("dict[str, StudioSocket]", scope["extensions"][_EXTENSION])
    return extension["protocol"]


class Framer:
    """Frames messages; of a message sent to many in a row the frame is made once."""

    def __init__(self) -> None:
        self._payload: bytes | None = None
        self._binary = False
        self._frame = b""

    def frame(self, payload: bytes, *, binary: bool) -> bytes:
        """Return the frame of one whole message, unmasked."""
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


SERVER_ENDS: Final = 1012
"""The close code with which uvicorn ends its websockets; the page waits for the return."""
_FRAMER: Final = Framer()
"""Shared by all lanes, because one message goes to many of them in a row."""
_GOODBYE_S: Final = 5.0
"""For the closing handshake, and for what is still to be sent before it."""


def text_frame(payload: bytes) -> bytes:
    """Return the frame of one text message."""
    return _FRAMER.frame(payload, binary=False)


def binary_frame(payload: bytes) -> bytes:
    """Return the frame of one binary message."""
    return _FRAMER.frame(payload, binary=True)


def binary_head(length: int) -> bytes:
    """Return what goes before the bytes of one binary message, for who writes both at once."""
    return _head(length, binary=True)


class Lane:
    """The two ends of a websocket that was accepted; all of it runs on the loop's thread."""

    def __init__(self, websocket: WebSocket) -> None:
        self._websocket = websocket
        self.socket = socket_of(websocket.scope)
        self._closing: asyncio.Task[None] | None = None
        self.server_ends = False
        """Set once `receive` answers None: whether it was the studio that went."""

    async def receive(self) -> bytes | None:
        """Return the next whole message, text as UTF-8; None once the other side is gone."""
        message = await self._websocket.receive()
        if message["type"] == "websocket.disconnect":
            self.server_ends = message["code"] == SERVER_ENDS
            return None
        text = message.get("text")
        return text.encode() if text is not None else message["bytes"]

    def write(self, data: bytes, /) -> None:
        """Send one whole binary message."""
        self.socket.write_frame(binary_frame(data))

    def pending_bytes(self) -> int:
        """Bytes written and not yet taken by the system."""
        return self.socket.pending_bytes()

    def on_drain(self, resume: Callable[[], object]) -> None:
        """Call `resume` whenever a full write buffer has emptied."""
        self.socket.on_drain = resume

    def close(self, code: int = 1000) -> None:
        """Begin the closing handshake; `receive` then answers None."""
        if self._closing is None and self._websocket.client_state is WebSocketState.CONNECTED:
            self._closing = asyncio.create_task(self._close(code))

    async def finish(self) -> None:
        """Begin the closing handshake, unless it has begun, and wait until it is sent."""
        self.close()
        if self._closing is not None:
            await self._closing

    async def _close(self, code: int) -> None:
        # Saying goodbye waits for a browser that takes nothing any more.
        self.socket.give_up_within(_GOODBYE_S)
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):  # the other side went first
            await self._websocket.close(code)


class FrameTransport:
    """A lane as an outlet's Transport of whole frames, so that text and binary keep their order."""

    def __init__(self, lane: Lane) -> None:
        # Past the lane: thousands of frames go in a second.
        self.write = lane.socket.write_frame
        self.pending_bytes = lane.socket.pending_bytes
