"""A process that serves the small engine: `python -m tests.support.small_studio FOLDER [MOOD]`.

MOOD `stuck`: its end never comes; `thread`: a thread of its pool never ends.
"""

from __future__ import annotations

import asyncio
import sys
import time
from pathlib import Path

from studio.server.app import make_app
from studio.server.assets import Assets
from studio.server.credentials import Credentials
from studio.server.front import Front
from studio.server.origin import KnownHosts
from studio.server.ports import bind, page_address, port_of, with_token
from studio.server.server import Server
from tests.support.small_engine import SmallEngine

_FOREVER_S = 1000.0


class _Life:
    def __init__(self, line: str, mood: str) -> None:
        self._line, self._mood = line, mood

    async def begin(self) -> None:
        if self._mood == "thread":
            asyncio.get_running_loop().run_in_executor(None, time.sleep, _FOREVER_S)

    async def answering(self) -> None:
        sys.stdout.write(f"Studio: {self._line}\n")
        sys.stdout.flush()

    async def end(self) -> None:
        if self._mood == "stuck":
            time.sleep(_FOREVER_S)  # noqa: ASYNC251 - that is what being stuck means


def main(folder: Path, mood: str = "") -> None:
    credentials = Credentials("token", bytes(32))
    listener = bind("127.0.0.1", 0)
    port = port_of(listener)
    app = make_app(
        SmallEngine(),
        Assets(folder),
        credentials,
        "session",
        Front(KnownHosts.of("127.0.0.1"), port),
    )
    life = _Life(with_token(page_address("127.0.0.1", port), "token"), mood)
    Server(app, life).run(sockets=[listener])


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
