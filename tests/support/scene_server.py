"""Serves one DocumentScene as web does: viser's page, our assets and the websocket, on one port."""

from __future__ import annotations

import asyncio
import http
import mimetypes
import threading
from typing import TYPE_CHECKING, TypeVar

from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.protocol import State

from studio.scene import CLIENT_PATH, SUBPROTOCOL, DocumentScene, viser_client, viser_page
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from websockets.typing import Subprotocol

T = TypeVar("T")
ASSETS = repository_or_wheel("frontend_assets")


class Socket:
    """A Connection of the scene over one accepted websocket."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection

    async def receive(self) -> bytes | None:
        try:
            data = await self._connection.recv()
        except ConnectionClosed:
            return None
        return data if isinstance(data, bytes) else data.encode()

    def write(self, data: bytes, /) -> None:
        protocol = self._connection.protocol
        if protocol.state is State.OPEN:
            protocol.send_binary(data)
            self._connection.transport.write(b"".join(protocol.data_to_send()))

    def pending_bytes(self) -> int:
        return self._connection.transport.get_write_buffer_size()

    def on_drain(self, resume: Callable[[], object], /) -> None:
        """It is looked at again and again."""

    def close(self, code: int, /) -> None:
        self._closing = asyncio.ensure_future(self._connection.close(code))


class SceneServer:
    """The loop runs in a thread of its own; `call` runs something there and waits for it.

    Page: `url`; websocket: the same without the slash. `allowed` may be replaced by a test, and
    so may `handshake_s`: how long each websocket waits before it is accepted.
    """

    def __init__(self) -> None:
        self.allowed: Callable[[str], bool] = lambda _: True
        self.handshake_s = 0.0
        self.connections: set[ServerConnection] = set()
        self._loop = asyncio.new_event_loop()
        self._ready = threading.Event()
        self._stop = asyncio.Event()
        self._thread = threading.Thread(target=self._loop.run_until_complete, args=(self._run(),))

    def __enter__(self) -> SceneServer:
        self._thread.start()
        assert self._ready.wait(60)
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join(60)
        self._loop.close()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/d/one/viser/"

    @property
    def websocket_url(self) -> str:
        return f"ws://127.0.0.1:{self.port}/d/one/viser"

    def call(self, function: Callable[[DocumentScene], T]) -> T:
        async def run() -> T:
            return function(self.scene)

        return self.wait_for(run())

    def wait_for(self, coroutine: Coroutine[None, None, T]) -> T:
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(60)

    def drop_connections(self) -> None:
        """Cut every websocket, as a network does."""

        def cut() -> None:
            for connection in self.connections:
                connection.transport.abort()

        self._loop.call_soon_threadsafe(cut)

    async def _run(self) -> None:
        self.scene = DocumentScene(asyncio.get_running_loop())
        async with serve(
            self._serve,
            "127.0.0.1",
            0,
            compression=None,
            process_request=self._answer,
            subprotocols=[_subprotocol()],
            ping_interval=None,
        ) as server:
            self.port = int(next(iter(server.sockets)).getsockname()[1])
            self._ready.set()
            await self._stop.wait()
            self.scene.close()

    async def _serve(self, connection: ServerConnection) -> None:
        self.connections.add(connection)
        try:
            await self.scene.serve(Socket(connection), self.allowed, connection.subprotocol)
        finally:
            self.connections.discard(connection)

    async def _answer(self, _: ServerConnection, request: Request) -> Response | None:
        path = request.path.partition("?")[0]
        if request.headers.get("Upgrade"):
            await asyncio.sleep(self.handshake_s)
            return None
        if path == "/d/one/viser/":
            return _response("text/html", viser_page("/a"))
        if path == f"/a/{CLIENT_PATH}":
            return _response("application/zstd", viser_client())
        file = ASSETS / path.removeprefix("/a/")
        if path.startswith("/a/") and file.is_file():
            kind = mimetypes.guess_type(file.name)[0] or "application/octet-stream"
            return _response(kind, file.read_bytes())
        if path == "/frame":
            return _response("text/html", _FRAME.encode())
        return Response(http.HTTPStatus.NOT_FOUND, "Not Found", Headers())


_FRAME = """<!doctype html><style>body{margin:0}iframe{border:0;width:100vw;height:100vh}</style>
<iframe src="/d/one/viser/"></iframe>"""


def _subprotocol() -> Subprotocol:
    from websockets.typing import Subprotocol as Name

    return Name(SUBPROTOCOL)


def _response(kind: str, body: bytes) -> Response:
    headers = Headers(
        {
            "Content-Type": kind,
            "Content-Length": str(len(body)),
            "Cache-Control": "no-store",
        }
    )
    return Response(http.HTTPStatus.OK, "OK", headers, body)
