"""Relays that run as processes of their own, or in this one, and a class that is shared by them."""

from __future__ import annotations

import asyncio
import os
import re
import signal
import socket
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from studio.ros.wire.certificates import new_secret
from studio.scene import CLIENT_PATH, viser_client
from studio.server.assets import Assets
from studio.server.origin import KnownHosts
from studio.server.ports import bind, port_of
from studio.server.relays.keys import RelayIdentity
from studio.server.relays.origin import Origin
from studio.server.relays.relay import Relay
from studio.server.server import Server
from tests.support.classmates import Classmate
from tests.support.served_class import ServedClass, served_class
from tests.support.warm_python import STUDIO, start_python

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Callable, Coroutine, Generator, Sequence
    from typing import Any

    from studio.server.relays.room import Room
    from studio.server.relays.uplink import Uplink
    from tests.support.warm_python import WarmProcess

_Result = TypeVar("_Result")
_PATIENCE_S = 60.0


def free_port() -> int:
    """A port of loopback that nobody listens on now."""
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


def wait_until(holds: Callable[[], object], what: str, patience_s: float = _PATIENCE_S) -> None:
    """Wait for a condition."""
    end_s = time.monotonic() + patience_s
    while not holds():
        assert time.monotonic() < end_s, f"never came: {what}"
        time.sleep(0.01)


class RelayProcess:
    """`studio relay`, which can be killed, stopped for a while, and started again where it was."""

    def __init__(self, folder: Path, *prefix: str, name: str = "127.0.0.1") -> None:
        """Choose its ports; `prefix` goes before the command, as `faketime +1h`."""
        self.folder, self._prefix, self.name = folder, prefix, name
        self.port, self.listen_port = free_port(), free_port()
        self.line = self.key = ""
        self.process: subprocess.Popen[str] | WarmProcess | None = None

    @property
    def address(self) -> str:
        """Of its page, without a room."""
        return f"http://{self.name}:{self.port}/"

    def start(self) -> None:
        """Start it, and wait until origins may dial in."""
        command = [
            *(*self._prefix, sys.executable, "-m", "studio", "relay"),
            *("--listen", f"tls/127.0.0.1:{self.listen_port}", "--port", str(self.port)),
            *("--data-dir", str(self.folder), "--name", self.name),
        ]
        with (self.folder / "relay.stderr").open("a") as errors:
            self.process = start_python(
                command, os.environ, stderr=errors.fileno(), imported=STUDIO
            )
        assert self.process.stdout is not None
        for text in self.process.stdout:
            if found := re.match(r"Relay: (tls/\S+#(\S+))", text):
                self.line, self.key = found[1], found[2]
                return
        raise AssertionError("the relay ended before it listened")

    def kill(self) -> None:
        """End it at once, as a machine that loses its power."""
        self._signal(signal.SIGKILL)
        assert self.process is not None
        self.process.wait(_PATIENCE_S)
        self._close_pipe()

    def pause(self) -> None:
        """Let it stand still."""
        self._signal(signal.SIGSTOP)

    def resume(self) -> None:
        """Let it go on."""
        self._signal(signal.SIGCONT)

    def end(self) -> None:
        """End it as Ctrl-C does, if it runs."""
        if self.process is not None and self.process.poll() is None:
            self.resume()
            self.process.terminate()
            self.process.wait(_PATIENCE_S)
            self._close_pipe()

    def _close_pipe(self) -> None:
        if self.process is not None and self.process.stdout is not None:
            self.process.stdout.close()

    def _signal(self, number: signal.Signals) -> None:
        assert self.process is not None
        os.kill(self.process.pid, number)


@contextmanager
def relay_process(folder: Path, *prefix: str, name: str = "127.0.0.1") -> Generator[RelayProcess]:
    """A relay in a process of its own, found by a name."""
    folder.mkdir(parents=True, exist_ok=True)
    made = RelayProcess(folder, *prefix, name=name)
    try:
        made.start()
        yield made
    finally:
        made.end()


class ServedRelay:
    """A relay in this process, so that what it holds can be seen; its loop runs in a thread."""

    def __init__(self, relay: Relay, line: str, port: int) -> None:
        self.relay, self.line, self.port = relay, line, port
        self.address = f"http://127.0.0.1:{port}/"
        self.server: Server
        self._loop: asyncio.AbstractEventLoop | None = None
        self._listening = threading.Event()

    async def begin(self) -> None:
        """Begin with the server, as its life."""
        self._loop = asyncio.get_running_loop()
        await self.relay.begin()

    async def answering(self) -> None:
        """Browsers and origins may come."""
        await self.relay.answering()
        self._listening.set()

    async def end(self) -> None:
        """End with the server."""
        await self.relay.end()

    def wait_listening(self) -> None:
        """Wait until origins may dial in."""
        assert self._listening.wait(_PATIENCE_S)

    def run(self, work: Coroutine[Any, Any, _Result]) -> _Result:
        """What some work on the relay's loop returns."""
        assert self._loop is not None
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(_PATIENCE_S)

    def look(self, work: Callable[[], _Result]) -> _Result:
        """What a function returns that is called on the relay's loop."""

        async def call() -> _Result:
            return work()

        return self.run(call())

    def room(self) -> Room:
        """Its one room, once its origin has said what it is."""
        rooms = self.relay.rooms
        wait_until(lambda: any(one.state for one in rooms.values()), "the room")
        return next(iter(rooms.values()))


@contextmanager
def served_relay() -> Generator[ServedRelay]:
    """A relay in this process."""
    listener = bind("127.0.0.1", 0)
    port, listen_port = port_of(listener), free_port()
    identity = RelayIdentity(new_secret())
    client = viser_client()
    assets = Assets(
        Path(__file__).resolve().parents[2] / "frontend_assets", {CLIENT_PATH: lambda: client}
    )
    endpoint = f"tls/127.0.0.1:{listen_port}"
    relay = Relay(
        endpoint=endpoint,
        identity=identity,
        address=f"http://127.0.0.1:{port}/",
        assets=assets,
        hosts=KnownHosts.of("127.0.0.1"),
        port=port,
    )
    served = ServedRelay(relay, f"{endpoint}#{identity.key}", port)
    served.server = Server(relay, served)
    relay.crowd = served.server.server_state.crowd
    thread = threading.Thread(target=served.server.run, kwargs={"sockets": [listener]})
    thread.start()
    try:
        served.wait_listening()
        yield served
    finally:
        served.server.should_exit = True
        thread.join(_PATIENCE_S)


class RelayedClass:
    """A served class, and the lines of its studio to relays."""

    def __init__(self, served: ServedClass) -> None:
        self.served = served
        self.origin: Origin = served.look(
            lambda: Origin(served.engine, served.classroom, "session")
        )

    def dial(self, line: str) -> None:
        """Share the class by a relay, and wait until it serves it."""
        relay = self.served.run(self.origin.dial(line))
        uplink = self.uplink(relay.endpoint)
        wait_until(lambda: uplink.state == "there", f"the relay ({uplink.reason})")

    def uplink(self, endpoint: str = "") -> Uplink:
        """The line to a relay, or to the only one."""
        found = self.origin.uplinks
        return found[endpoint] if endpoint else next(iter(found.values()))

    def address(self, endpoint: str = "") -> str:
        """Of the room's page at a relay, or at the only one."""
        return self.uplink(endpoint).address

    @contextmanager
    def student(self, name: str, endpoint: str = "") -> Generator[Classmate]:
        """A browser of somebody who joins at a relay."""
        made = Classmate(self.address(endpoint))
        try:
            code = self.served.classroom.admission.code
            wait_until(lambda: made.client.get("/join").status_code == 200, "the form")
            assert made.join(name, code).status_code == 303
            yield made
        finally:
            made.close()

    def close(self) -> None:
        """End all lines."""
        self.served.run(self.origin.close())


@contextmanager
def relayed_class(folder: Path, lines: Sequence[str]) -> Generator[RelayedClass]:
    """A class with an open rover, shared by the relays of these lines."""
    with served_class(folder) as served:
        made = RelayedClass(served)
        try:
            for line in lines:
                made.dial(line)
            yield made
        finally:
            made.close()


@contextmanager
def line_cut(relay: ServedRelay, room: RelayedClass) -> Generator[None]:
    """No line between the class and its one relay, until the block ends."""
    endpoint = room.uplink().relay.endpoint
    room.served.run(room.origin.remove(endpoint))
    wait_until(lambda: not relay.room().is_there, "the relay's notice of it")
    yield
    room.dial(relay.line)
    wait_until(lambda: relay.room().is_there, "the studio")
