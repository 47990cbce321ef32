"""A browser whose page hangs, or that is gone unsaid: it reads nothing and answers nothing."""

from __future__ import annotations

import json
import socket
from contextlib import contextmanager
from typing import TYPE_CHECKING

from websockets.frames import Frame, Opcode

from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.web_server import RunningWeb

_RECEIVES_BYTES = 1 << 16
"""As little as it gets: what else is sent to it waits in the studio."""


class DeafBrowser:
    """An open websocket, of which nothing is read after the handshake."""

    def __init__(self, opened: socket.socket) -> None:
        self._socket = opened

    def say(self, **message: object) -> None:
        """Send one message."""
        frame = Frame(Opcode.TEXT, json.dumps(message).encode())
        self._socket.sendall(frame.serialize(mask=True))


@contextmanager
def deaf_browser(web: RunningWeb, path: str) -> Generator[DeafBrowser]:
    """Open a lane, and from then on be deaf."""
    with socket.socket() as opened:
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVES_BYTES)
        opened.connect(("127.0.0.1", web.port))
        head = (
            f"GET {path} HTTP/1.1",
            f"Host: 127.0.0.1:{web.port}",
            f"Origin: {web.origin}",
            f"Cookie: {web.cookie(Role.PRESENTER)}",
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        )
        opened.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
        assert b" 101 " in opened.recv(64)
        yield DeafBrowser(opened)
