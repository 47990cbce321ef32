"""The studio with one more websocket, `/echo`: what a bare round trip through its server costs.

`python -m tests.benchmarks.echo_studio open FILE ...` takes the arguments of `studio`. The first
message to `/echo` is kept; every later one is answered by it, on the lanes that the studio uses.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from starlette.websockets import WebSocket

from studio.cli import main
from studio.server import launch
from studio.server.app import make_app
from studio.server.websocket import Lane

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Receive, Scope, Send

    from studio.server.assets import Assets
    from studio.server.credentials import Credentials
    from studio.server.front import Front
    from studio.server.surface import OpenDocuments

PATH = "/echo"


class EchoBeside:
    """Serves `/echo` itself and leaves everything else to the studio."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One connection."""
        if scope["type"] == "websocket" and scope["path"] == PATH:
            await _echo(WebSocket(scope, receive, send))
        else:
            await self._app(scope, receive, send)


async def _echo(websocket: WebSocket) -> None:
    await websocket.accept()
    lane = Lane(websocket)
    answer = await lane.receive() or b""
    while await lane.receive() is not None:
        lane.write(answer)
    await lane.finish()


def _make_app_with_echo(
    engine: OpenDocuments,
    assets: Assets,
    credentials: Credentials,
    session: str,
    front: Front,
) -> ASGIApp:
    return EchoBeside(make_app(engine, assets, credentials, session, front))


if __name__ == "__main__":
    launch.make_app = _make_app_with_echo
    sys.exit(main())
