"""The real application on a real port, in a thread of the test's process."""

from __future__ import annotations

import asyncio
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import httpx2
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from studio.protocol.roles import Role
from studio.server.app import make_app
from studio.server.assets import Assets
from studio.server.credentials import Credentials
from studio.server.front import Front
from studio.server.origin import KnownHosts
from studio.server.ports import bind, port_of
from studio.server.server import Server
from studio.server.websocket import StudioSocket
from tests.support.classmates import CLOSE_S
from tests.support.small_engine import SmallEngine

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable, Coroutine, Generator, Mapping
    from pathlib import Path

    from websockets.sync.connection import Connection

    from studio.classroom.members import Member

KEY = bytes(32)
TOKEN = "the-presenters-token"
_PING_S = 0.1


class RunningWeb:
    """Where it runs and how to reach it."""

    def __init__(
        self,
        engine: SmallEngine,
        credentials: Credentials,
        port: int,
        server: Server,
        loop: asyncio.AbstractEventLoop,
    ) -> None:
        self.engine, self.credentials, self.port = engine, credentials, port
        self.origin = f"http://127.0.0.1:{port}"
        self._server, self._loop = server, loop
        self._members: dict[Role, Member] = {}

    def pending_bytes(self) -> list[int]:
        """What the system has not yet taken, of every websocket that is open."""
        found = tuple(self._server.server_state.connections)
        return [one.pending_bytes() for one in found if isinstance(one, StudioSocket)]

    def run(self, work: Coroutine[Any, Any, None]) -> None:
        """Do something on the loop of the server, and wait for it."""
        asyncio.run_coroutine_threadsafe(work, self._loop).result(60)

    def member(self, role: Role) -> Member:
        """A person of the class, always the same of one role; the class is open then."""
        classroom = self.engine.classroom
        classroom.admission.open = True
        if self._members.get(role) not in tuple(classroom.members):
            self._members[role] = classroom.members.add(role.value, role)
        return self._members[role]

    def cookie(self, role: Role) -> str:
        """The `Cookie` header of a role."""
        if role in {Role.PRESENTER, Role.GUEST}:
            return f"studio-{self.port}={self.credentials.cookie_of(role)}"
        value = self.engine.classroom.members.cookie_of(self.member(role))
        return f"studio-{self.port}-member={value}"

    @contextmanager
    def in_control(self, role: Role) -> Generator[None]:
        """Within this block the member of a role has control; the presenter, if it is theirs."""
        control = self.engine.classroom.control
        control.give("" if role is Role.PRESENTER else self.member(role).person, "small")
        try:
            yield
        finally:
            control.give("")

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
            close_timeout=CLOSE_S,
        )


class _Life:
    """Tells the test's thread when the port answers."""

    def __init__(self) -> None:
        self.answers = threading.Event()

    async def begin(self) -> None:
        """Nothing to begin."""

    async def answering(self) -> None:
        self.loop = asyncio.get_running_loop()
        self.answers.set()

    async def end(self) -> None:
        """Nothing to end."""


@contextmanager
def running_web(  # noqa: PLR0913 - each test gives one or two
    assets: Path,
    *,
    token: str = TOKEN,
    guests: bool = False,
    base: str = "",
    proxies: frozenset[str] = frozenset(),
    host: str = "127.0.0.1",
    patience_s: float | None = None,
    neighbours: Callable[[], tuple[str, ...]] | None = None,
) -> Generator[RunningWeb]:
    """Serve until the block ends; with a patience, browsers are always asked if they are there.

    With neighbours it is as a relay serves.
    """
    engine, credentials, life = SmallEngine(), Credentials(token, KEY, guests=guests), _Life()
    listener: socket.socket = bind("127.0.0.1", 0)
    port = port_of(listener)
    app = make_app(
        engine,
        Assets(assets),
        credentials,
        "session",
        Front(KnownHosts.of(host), port, base, proxies),
        neighbours,
    )
    server = Server(app, life)
    engine.classroom.end_pages = server.server_state.crowd.end_person
    if patience_s is not None:
        server.config.ws_ping_interval, server.config.ws_ping_timeout = _PING_S, patience_s
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    assert life.answers.wait(60)
    try:
        yield RunningWeb(engine, credentials, port, server, life.loop)
    finally:
        server.should_exit = True
        thread.join(60)
        assert not thread.is_alive()
