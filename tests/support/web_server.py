"""The real application on a real port, in a thread of the test's process."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

import httpx2
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from studio.protocol.roles import Role
from studio.server.app import make_app
from studio.server.assets import Assets
from studio.server.credentials import Credentials
from studio.server.ports import bind, port_of
from studio.server.server import Server
from studio.server.websocket import StudioSocket
from tests.support.small_engine import SmallEngine

if TYPE_CHECKING:
    import socket
    from collections.abc import Generator, Mapping
    from pathlib import Path

    from websockets.sync.connection import Connection

KEY = bytes(32)
TOKEN = "the-presenters-token"
_PING_S = 0.1


class RunningWeb:
    """Where it runs and how to reach it."""

    def __init__(
        self, engine: SmallEngine, credentials: Credentials, port: int, server: Server
    ) -> None:
        self.engine, self.credentials, self.port = engine, credentials, port
        self.origin = f"http://127.0.0.1:{port}"
        self._server = server

    def pending_bytes(self) -> list[int]:
        """What the system has not yet taken, of every websocket that is open."""
        found = tuple(self._server.server_state.connections)
        return [one.pending_bytes() for one in found if isinstance(one, StudioSocket)]

    def cookie(self, role: Role) -> str:
        """The `Cookie` header of a role."""
        return f"studio-{self.port}={self.credentials.cookie_of(role)}"

    def client(
        self, role: Role | None = None, headers: Mapping[str, str] | None = None
    ) -> httpx2.Client:
        """An HTTP client; with a role it sends that role's cookie and our own origin."""
        own = {"cookie": self.cookie(role), "origin": self.origin} if role else {}
        return httpx2.Client(
            base_url=self.origin,
            headers=own | dict(headers or {}),
            trust_env=False,
            verify=False,  # of plain HTTP: to read certificates takes 20 ms
            timeout=60,
        )

    def websocket(
        self,
        path: str,
        role: Role | None = Role.PRESENTER,
        *,
        origin: str | None = "own",
        subprotocols: tuple[str, ...] = (),
        headers: Mapping[str, str] | None = None,
    ) -> Connection:
        """A websocket as a browser page of `origin` would open it."""
        wanted = self.origin if origin == "own" else origin
        cookie = {"Cookie": self.cookie(role)} if role else {}
        return connect(
            f"ws://127.0.0.1:{self.port}{path}",
            origin=Origin(wanted) if wanted is not None else None,
            subprotocols=[Subprotocol(one) for one in subprotocols] or None,
            additional_headers=cookie | dict(headers or {}),
            proxy=None,
            open_timeout=60,
            max_size=None,
        )


class _Life:
    """Tells the test's thread when the port answers."""

    def __init__(self) -> None:
        self.answers = threading.Event()

    async def begin(self) -> None:
        """Nothing to begin."""

    async def answering(self) -> None:
        self.answers.set()

    async def end(self) -> None:
        """Nothing to end."""


@contextmanager
def running_web(
    assets: Path,
    *,
    token: str | None = TOKEN,
    host: str = "127.0.0.1",
    patience_s: float | None = None,
) -> Generator[RunningWeb]:
    """Serve until the block ends; with a patience, browsers are always asked if they are there."""
    engine, credentials, life = SmallEngine(), Credentials(token, KEY), _Life()
    listener: socket.socket = bind("127.0.0.1", 0)
    port = port_of(listener)
    app = make_app(engine, Assets(assets), credentials, "session", (host, port))
    server = Server(app, life)
    if patience_s is not None:
        server.config.ws_ping_interval, server.config.ws_ping_timeout = _PING_S, patience_s
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    assert life.answers.wait(60)
    try:
        yield RunningWeb(engine, credentials, port, server)
    finally:
        server.should_exit = True
        thread.join(60)
        assert not thread.is_alive()
