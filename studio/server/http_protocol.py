"""uvicorn's HTTP protocol with bounds for who sends, and its transport in sight.

uvicorn has no bound for a head when httptools parses it, nor for the time until one is complete;
its `limit_concurrency` would refuse the presenter along with the strangers that fill it.
"""

from __future__ import annotations

from http import HTTPStatus
from typing import TYPE_CHECKING, Any, Final, cast

import httptools
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from studio.server.crowd import STRANGER_S

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Sequence

    from starlette.types import Scope
    from uvicorn.config import Config
    from uvicorn.server import ServerState

    from studio.protocol.roles import Person
    from studio.server.crowd import CrowdedState

_EXTENSION: Final = "studio.connection"
_HEAD_LIMIT_BYTES: Final = 64 << 10
"""Limit of the request line and all headers together; browsers send less than 8 KiB."""
_URL_LIMIT_BYTES: Final = 16 << 10
_HEADERS_MAX: Final = 100
_WAITING_MAX: Final = 8
"""Requests that may follow one that is not answered yet; browsers send none."""


class _RefusedError(Exception):
    """Stops the parser, which is in the middle of the request."""


class StudioConnection(HttpToolsProtocol):
    """A connection on which a chunked body may be written past ASGI, without waiting or copying.

    ASGI's `send` waits for the transport, and joins the bytes with their framing once per client.
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
        self._deadline: asyncio.TimerHandle | None = None
        self._head_bytes = self._kept_bytes = self._header_count = 0
        self._refusal: tuple[HTTPStatus, str] | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin as a stranger, who has little time."""
        super().connection_made(transport)
        self._crowd.arrive(self)
        self._limit_time()

    def connection_lost(self, exc: Exception | None) -> None:
        """Remove the connection from the crowd."""
        self._crowd.leave(self)
        self._allow_time()
        super().connection_lost(exc)

    def recognise(self, visitor: Person | None) -> bool:
        """Assign the connection to a person; False when they have too many."""
        if visitor is None:
            self._crowd.leave(self)
            self._crowd.arrive(self)
            return True
        if not self._crowd.recognise(self, visitor):
            return False
        self._allow_time()
        return True

    def spend(self, units: float) -> float:
        """Count what came; answers for how many seconds it has to wait."""
        return self._crowd.spend(self, units)

    def end_all(self) -> None:
        """End the connections of all who came with a cookie or a token, this one too."""
        self._crowd.end_all()

    def data_received(self, data: bytes) -> None:
        """Parse what came; what the parser keeps to itself meanwhile is bounded, too."""
        self._unset_keepalive_if_required()
        if self.parser is None:  # the connection was lost
            return
        self._kept_bytes += len(data)
        try:
            self.parser.feed_data(data)
        except httptools.HttpParserUpgrade:
            if self._should_upgrade():  # else it is answered as any request
                self.handle_websocket_upgrade()
        except httptools.HttpParserError:
            self._refuse()
        else:
            if self._kept_bytes > _HEAD_LIMIT_BYTES:
                self._too_large()
                self._refuse()

    def handle_websocket_upgrade(self) -> None:
        """Hand the connection over to the websocket's protocol."""
        self._allow_time()
        self._crowd.leave(self)
        super().handle_websocket_upgrade()

    def on_message_begin(self) -> None:
        """The first byte of a request; others may wait for their answers."""
        self._received()
        if len(self.pipeline) >= _WAITING_MAX:
            self._refusal = HTTPStatus.TOO_MANY_REQUESTS, "Wait for the answers."
            raise _RefusedError
        self._head_bytes = self._header_count = 0
        self._limit_time()
        super().on_message_begin()

    def on_url(self, url: bytes) -> None:
        """A piece of the address."""
        self._received()
        self._head_bytes += len(url)
        if self._head_bytes > _URL_LIMIT_BYTES:
            self._refusal = HTTPStatus.REQUEST_URI_TOO_LONG, "The address is too long."
            raise _RefusedError
        super().on_url(url)

    def on_header(self, name: bytes, value: bytes) -> None:
        """A header, or a trailer behind a body."""
        self._received()
        self._header_count += 1
        self._head_bytes += len(name) + len(value)
        if self._header_count > _HEADERS_MAX or self._head_bytes > _HEAD_LIMIT_BYTES:
            self._too_large()
            raise _RefusedError
        super().on_header(name, value)

    def on_headers_complete(self) -> None:
        """Let the application find its connection: the task that runs it has not begun yet."""
        self._received()
        super().on_headers_complete()
        self.scope["extensions"] = {_EXTENSION: {"protocol": self}}  # type: ignore[typeddict-item]

    def on_body(self, body: bytes) -> None:
        """A piece of the body."""
        self._received()
        super().on_body(body)

    def on_message_complete(self) -> None:
        """The last byte of a request."""
        self._received()
        super().on_message_complete()

    def resume_writing(self) -> None:
        """Pass on that there is room again."""
        super().resume_writing()
        if self.on_drain is not None:
            self.on_drain()

    def write_chunk(self, parts: Sequence[bytes]) -> None:
        """Write one chunk of a chunked body (RFC 9112 section 7.1), its parts one after another."""
        if not self.transport.is_closing():
            size = sum(map(len, parts))
            self.transport.writelines((b"%x\r\n" % size, *parts, b"\r\n"))

    def pending_bytes(self) -> int:
        """Bytes written and not yet taken by the system."""
        return self.transport.get_write_buffer_size()

    def abort(self) -> None:
        """End it at once, with what was not taken yet."""
        self.transport.abort()

    def _received(self) -> None:
        """The parser has passed on what it had."""
        self._kept_bytes = 0

    def _limit_time(self) -> None:
        if self._deadline is None:
            self._deadline = self.loop.call_later(STRANGER_S, self.abort)

    def _allow_time(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _too_large(self) -> None:
        self._refusal = HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE, "The headers are too long."

    def _refuse(self) -> None:
        """Answer what is no request that is read here, and read nothing more."""
        status, sentence = self._refusal or (HTTPStatus.BAD_REQUEST, "This is no HTTP request.")
        self._crowd.refuse(sentence[:-1].lower())
        lines = (
            f"HTTP/1.1 {status.value} {status.phrase}",
            "content-type: text/plain; charset=utf-8",
            f"content-length: {len(sentence)}",
            "connection: close",
        )
        self.transport.write(("\r\n".join(lines) + "\r\n\r\n" + sentence).encode())
        self.transport.close()


def connection_of(scope: Scope) -> StudioConnection:
    """Return the protocol that serves this request."""
    extension = cast("dict[str, StudioConnection]", scope["extensions"][_EXTENSION])
    return extension["protocol"]
