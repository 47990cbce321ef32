"""Whoever speaks raw bytes to a server: strangers before any key, and viewers past the browser."""

from __future__ import annotations

import socket
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from websockets.frames import Frame, Opcode

from studio.protocol.roles import Role
from studio.scene import SUBPROTOCOL

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.web_server import RunningWeb

_TIMEOUT_S = 60.0
_CHUNK_BYTES = 1 << 16


@contextmanager
def dialled(web: RunningWeb) -> Generator[socket.socket]:
    """An open connection that has said nothing."""
    with socket.create_connection(("127.0.0.1", web.port), timeout=_TIMEOUT_S) as opened:
        yield opened


def until_end(opened: socket.socket) -> bytes:
    """All that the server says until it ends the connection."""
    said = bytearray()
    with suppress(ConnectionError):
        while part := opened.recv(_CHUNK_BYTES):
            said += part
    return bytes(said)


def pour(opened: socket.socket, part: bytes, most_bytes: int) -> int:
    """Send the same again and again until the server does not take it; answers how much it took."""
    sent = 0
    with suppress(ConnectionError):
        while sent < most_bytes:
            opened.sendall(part)
            sent += len(part)
    return sent


def handshake(web: RunningWeb, path: str, role: Role | None, *more: str) -> bytes:
    """The head with which a browser's page opens a websocket."""
    lines = [
        f"GET {path} HTTP/1.1",
        f"Host: 127.0.0.1:{web.port}",
        f"Origin: {web.origin}",
        *([f"Cookie: {web.cookie(role)}"] if role else []),
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        *more,
    ]
    return ("\r\n".join(lines) + "\r\n\r\n").encode()


@contextmanager
def raw_websocket(
    web: RunningWeb, path: str, role: Role | None = Role.GUEST
) -> Generator[socket.socket]:
    """An open websocket whose frames are made by hand."""
    with dialled(web) as opened:
        opened.sendall(handshake(web, path, role, f"Sec-WebSocket-Protocol: {SUBPROTOCOL}"))
        head = b""
        while b"\r\n\r\n" not in head:
            head += opened.recv(1)
        assert b" 101 " in head
        yield opened


def frame(opcode: Opcode, payload: bytes = b"", *, final: bool = True) -> bytes:
    """One frame as a client sends it."""
    return Frame(opcode, payload, fin=final).serialize(mask=True)


def resident_bytes() -> int:
    """Memory of this process, in which the server runs, too (Linux)."""
    fields = Path("/proc/self/statm").read_text().split()
    return int(fields[1]) * 4096
