"""One open websocket as the lanes use it: bytes in by `receive`, bytes out without waiting."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING, Final

from starlette.websockets import WebSocketDisconnect, WebSocketState

from studio.server.websocket_protocol import Framer, socket_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.websockets import WebSocket

SERVER_ENDS: Final = 1012
"""The close code with which uvicorn ends its websockets; the page waits for the return."""
_FRAMER: Final = Framer()
"""One for all lanes, because one message goes to many of them in a row."""
_GOODBYE_S: Final = 5.0
"""For the closing handshake, and for what is still to be sent before it."""


def text_frame(payload: bytes) -> bytes:
    """The frame of one text message."""
    return _FRAMER.frame(payload, binary=False)


def binary_frame(payload: bytes) -> bytes:
    """The frame of one binary message."""
    return _FRAMER.frame(payload, binary=True)


class Lane:
    """The two ends of a websocket that was accepted; all of it runs on the loop's thread."""

    def __init__(self, websocket: WebSocket) -> None:
        self._websocket = websocket
        self.socket = socket_of(websocket.scope)
        self._closing: asyncio.Task[None] | None = None
        self.server_ends = False
        """Set once `receive` answers None: whether it was the studio that went."""

    async def receive(self) -> bytes | None:
        """The next whole message, text as UTF-8; None once the other side is gone."""
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
        """Begin the closing handshake, if nobody did, and see it on its way."""
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
