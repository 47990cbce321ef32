"""A class with an open rover at a real port, in this process, so that what it holds can be seen."""

from __future__ import annotations

import asyncio
import json
import secrets
import shutil
import socket
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from websockets.frames import Frame, Opcode

from studio.classroom.classroom import Classroom, Reach
from studio.documents.engine import Engine
from studio.protocol.roles import Role
from studio.scene import CLIENT_PATH, viser_client
from studio.server.app import make_app
from studio.server.assets import Assets
from studio.server.credentials import Credentials
from studio.server.front import Front
from studio.server.origin import KnownHosts
from studio.server.ports import bind, port_of
from studio.server.server import Server
from studio.settings import Settings
from tests.support.classmates import Classmate

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator

    from studio.classroom.members import Member
    from studio.documents.document import Document
    from tests.support.classmates import Lane

_Result = TypeVar("_Result")
_PATIENCE_S = 60.0
MODELS = Path(__file__).resolve().parents[2] / "models"


class RawLane:
    """A member's control lane of which the frames are made by hand, and nothing is read."""

    def __init__(self, port: int, cookie: str) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=_PATIENCE_S)
        lines = (
            "GET /control HTTP/1.1",
            f"Host: 127.0.0.1:{port}",
            f"Origin: http://127.0.0.1:{port}",
            f"Cookie: {cookie}",
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        )
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        head = b""
        while b"\r\n\r\n" not in head:
            head += self.socket.recv(1)
        assert b" 101 " in head

    def say(self, kind: str, **fields: object) -> None:
        """Send a command."""
        self.socket.sendall(text_frame(json.dumps({"type": kind, **fields}).encode()))


def text_frame(payload: bytes) -> bytes:
    """A message as a browser sends it."""
    return Frame(Opcode.TEXT, payload).serialize(mask=True)


class ServedClass:
    """A running class; what is asked of its engine is asked on the server's loop."""

    def __init__(self, engine: Engine, credentials: Credentials, port: int, folder: Path) -> None:
        self.engine, self.port, self.folder = engine, port, folder
        self.classroom = engine.classroom
        self.origin = f"http://127.0.0.1:{port}"
        self._credentials = credentials
        self._loop: asyncio.AbstractEventLoop | None = None
        self._opened = threading.Event()
        self.server: Server

    async def begin(self) -> None:
        """Start the engine with the server, as its life."""
        self._loop = asyncio.get_running_loop()
        await self.engine.start()

    async def answering(self) -> None:
        """Open the rover."""
        self._opening = asyncio.create_task(self._open())

    async def end(self) -> None:
        """End the engine before the connections are closed."""
        await self.engine.close()

    async def _open(self) -> None:
        shutil.copytree(MODELS / "rover_description", self.folder / "rover_description")
        entry = self.folder / "rover_description/urdf/rover.urdf.xacro"
        await self.engine.document(await self.engine.open_path(entry, {})).opened()
        await self.classroom.start()
        self._opened.set()

    def wait_opened(self) -> None:
        """Wait until the rover is there."""
        assert self._opened.wait(_PATIENCE_S)

    def run(self, work: Coroutine[Any, Any, _Result]) -> _Result:
        """What some work on the server's loop returns."""
        assert self._loop is not None
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(_PATIENCE_S)

    def look(self, work: Callable[[], _Result]) -> _Result:
        """What a function returns that is called on the server's loop."""

        async def call() -> _Result:
            return work()

        return self.run(call())

    @property
    def rover(self) -> Document:
        """The shared document."""
        return self.engine.documents["rover"]

    def site(self, name: str) -> str:
        """The id of a site of the rover."""
        found = self.look(self.rover.sites.event).changed
        return next(one.id for one in found if one.name.endswith(name))

    def member(self, name: str) -> tuple[Member, str]:
        """Somebody who has joined, with the `Cookie` header of their browser."""
        made = self.look(lambda: self.classroom.members.add(name, Role.STUDENT))
        return made, f"studio-{self.port}-member={self.classroom.members.cookie_of(made)}"

    @contextmanager
    def student(self, name: str) -> Generator[tuple[Classmate, str]]:
        """A browser of somebody who joins by the code, and the person that they are."""
        made = Classmate(self.origin)
        try:
            assert made.join(name, self.classroom.admission.code).status_code == 303
            yield made, next(one.person for one in self.classroom.members if one.name == name)
        finally:
            made.close()

    @property
    def url(self) -> str:
        """The presenter's address."""
        return f"{self.origin}/?token={self._credentials.token}"

    @contextmanager
    def presenter(self) -> Generator[Classmate]:
        """The presenter's browser."""
        made = Classmate(self.origin)
        try:
            made.client.get(self.url)
            yield made
        finally:
            made.close()

    @contextmanager
    def presenting(self) -> Generator[Lane]:
        """The control lane of the presenter's page, which shows the rover."""
        with self.presenter() as browser, browser.lane() as lane:
            lane.ask("watch", document="rover")
            yield lane


@contextmanager
def served_class(
    folder: Path, neighbours: Callable[[], tuple[str, ...]] | None = None
) -> Generator[ServedClass]:
    """Serve a class until the block ends; it keeps what it has in `folder`.

    With neighbours it is as a relay serves.
    """
    data = folder / "data"
    data.mkdir(parents=True)
    listener = bind("127.0.0.1", 0)
    port = port_of(listener)
    classroom = Classroom(data / "class-1.json", Reach((f"http://127.0.0.1:{port}/",)))
    engine = Engine(Settings(data_folder=data), classroom)
    credentials = Credentials(secrets.token_hex(8), secrets.token_bytes(32))
    served = ServedClass(engine, credentials, port, folder)
    front = Front(KnownHosts.of("127.0.0.1"), port)
    client = viser_client()
    assets = Assets(
        Path(__file__).resolve().parents[2] / "frontend_assets", {CLIENT_PATH: lambda: client}
    )
    app = make_app(engine, assets, credentials, "session", front, neighbours)
    served.server = Server(app, served)
    classroom.end_pages = served.server.server_state.crowd.end_person
    thread = threading.Thread(target=served.server.run, kwargs={"sockets": [listener]})
    thread.start()
    try:
        served.wait_opened()
        yield served
    finally:
        served.server.should_exit = True
        thread.join(_PATIENCE_S)
        assert not thread.is_alive()
