"""uvicorn's HTTP protocol, showing its transport: parts of a body that are shared by many."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, cast

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from starlette.types import Scope

_EXTENSION: Final = "studio.connection"


class StudioConnection(HttpToolsProtocol):
    """A connection on which a chunked body may be written past ASGI, without waiting or copying.

    ASGI's `send` waits for the transport, and joins the bytes with their framing once per client.
    """

    on_drain: Callable[[], object] | None = None
    """Called when a full write buffer has emptied."""

    def on_headers_complete(self) -> None:
        """Let the application find its connection: the task that runs it has not begun yet."""
        super().on_headers_complete()
        self.scope["extensions"] = {_EXTENSION: {"protocol": self}}  # type: ignore[typeddict-item]

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


def connection_of(scope: Scope) -> StudioConnection:
    """The protocol that serves this request."""
    extension = cast("dict[str, StudioConnection]", scope["extensions"][_EXTENSION])
    return extension["protocol"]
