"""uvicorn as the studio runs it: one port, shared bytes, an end within two seconds."""

from __future__ import annotations

import os
import threading
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Protocol

import uvicorn

from studio.protocol.commands import COMMAND_LIMIT_BYTES
from studio.server.crowd import CrowdedState
from studio.server.http_protocol import StudioConnection
from studio.server.websocket import StudioSocket

if TYPE_CHECKING:
    import socket
    from pathlib import Path
    from types import FrameType

    from starlette.types import ASGIApp

_PING_INTERVAL_S: Final = 20.0
_PING_TIMEOUT_S: Final = 60.0
_END_DEADLINE_S: Final = 1.7
"""From the signal to a forced exit, which does not wait for a stuck thread."""


class Life(Protocol):
    """Starts and ends with the server, on its loop."""

    async def begin(self) -> None:
        """Begin, before the first request."""
        ...

    async def answering(self) -> None:
        """Once, when the port answers; must not take long."""
        ...

    async def end(self) -> None:
        """End before the connections are closed, so that nobody waits for what has ended."""
        ...


class Server(uvicorn.Server):
    """uvicorn with a life beside it, and without raising a signal again that it obeyed."""

    def __init__(self, app: ASGIApp, life: Life, tls: tuple[Path, Path] | None = None) -> None:
        super().__init__(_configuration(app, tls))
        self.server_state = CrowdedState()
        self._life = life

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin the life, listen, and answer."""
        await self._life.begin()
        await super().startup(sockets)
        await self._life.answering()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End the work, then the connections."""
        await self._life.end()
        await super().shutdown(sockets)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """End at the first signal; at the second one without waiting."""
        del sig, frame  # not kept: uvicorn would raise the signal again after an orderly end
        self.force_exit = self.should_exit
        self.should_exit = True
        last_resort = threading.Timer(_END_DEADLINE_S, _leave)
        last_resort.daemon = True
        last_resort.start()


def _configuration(app: ASGIApp, tls: tuple[Path, Path] | None) -> uvicorn.Config:
    certificate, key = tls or (None, None)
    return uvicorn.Config(
        app,
        ssl_certfile=certificate,
        ssl_keyfile=key,
        proxy_headers=False,  # ours know which proxies are trusted, and their sub-path
        log_config=None,
        access_log=False,  # it would write the token of the first request
        lifespan="off",
        http=StudioConnection,
        ws=StudioSocket,
        ws_per_message_deflate=False,
        ws_max_size=COMMAND_LIMIT_BYTES,
        ws_ping_interval=_PING_INTERVAL_S,
        ws_ping_timeout=_PING_TIMEOUT_S,
        server_header=False,
        timeout_graceful_shutdown=1,
    )


def _leave() -> None:
    """Go at once: a save is a rename, so there is nothing that this could cut in two."""
    with suppress(OSError):
        os.write(2, b"The studio left without waiting for a task that did not end.\n")
    os._exit(0)
