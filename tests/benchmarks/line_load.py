"""Browsers of a class at the far end of a slow line, in one process: `python -m ... JOB`.

Each loads what its page loads in the order in which it does, by six connections, and has its two
lanes, which it opens again as the page and viser's client do. What comes is counted and not drawn.
It says a line of JSON once all are there, and one as the answer to each line of stdin: `look S`,
`back T` for when each is live again after that time, and `drop`, which ends all lanes.
"""

from __future__ import annotations

import asyncio
import contextlib
import gzip
import json
import os
import posixpath
import re
import struct
import sys
import time
from base64 import b64encode
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final
from urllib.parse import quote

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterable

CONNECTIONS: Final = 6
"""A browser opens so many to one server."""
RETRY_S: Final = (0.25, 0.5, 1.0, 2.0, 3.0)
"""Pauses of the page, as `RETRY_MS` of its `model/wire.js`."""
_GREETING_S: Final = 8.0
_CLIENT_PATIENCE_S, _VIEW_PATIENCE_S = 20.0, 3.0
"""For so long the editor waits for the 3D view's client, and then for its robot: `SLOW_LINE_MS` of
`lib/loading.js`, `PATIENCE_MS` of `app/panels.js`."""
_SLOW_S, _COURTESY_S = 4.0, 10.0
"""As `courtesyMs` of `lib/loading.js`."""
_SCENE_RETRY_S: Final = 1.0
_SCENE_OPENS_S: Final = 5.0
_ENCODINGS: Final = "gzip, deflate"
"""Browsers take no others over plain HTTP from another machine."""
_LATER: Final = ("panels/displays/displays.js", "panels/properties/properties.js")
_IDLE: Final = ("panels/source/editor.js",)
"""Modules of the first layout that the page imports by and by, and when it has nothing to do."""
_NAMED: Final = re.compile(r'(?:href|src|data-p)="([^"{}]+\.(?:js|css|zst))"')
_IMPORTED: Final = re.compile(r'\b(?:from|import)\s*"((?:\.{1,2}|vendor)/[^"]+\.js)"')
_BASE: Final = re.compile(r"/a/\w+/")
_VIEW: Final = struct.Struct("<9f")
_VIEW_BYTES: Final = 60
_SLOT_S: Final = 1 / 60
_LIVE_HZ: Final = 15
_FRESH_S: Final = 1.0
_PING, _PONG, _CLOSE = 9, 10, 8


@dataclass(frozen=True)
class Job:
    """Where to come, and who comes."""

    host: str
    port: int
    document: str
    code: str
    names: list[str]


@dataclass
class Browser:
    """One student's browser, and what came to it."""

    job: Job
    name: str
    cookie: str = ""
    came: int = 0
    """Bytes, with the heads of answers and frames."""
    frames_s: list[float] = field(default_factory=list[float])
    """When frames of the 3D view came, s since the epoch."""
    views: list[tuple[float, float]] = field(default_factory=list[tuple[float, float]])
    """When the presenter's view came, and how old it was, s."""
    state_s: float = 0.0
    there_s: float = 0.0
    editor_s: float = 0.0
    lost: int = 0
    """Lanes that ended."""

    def __post_init__(self) -> None:
        self._free: list[tuple[asyncio.StreamReader, asyncio.StreamWriter]] = []
        self._slots = asyncio.Semaphore(CONNECTIONS)
        self._known: dict[str, asyncio.Task[bytes]] = {}
        self._state, self._scene = asyncio.Event(), asyncio.Event()
        self._lanes: dict[str, asyncio.StreamWriter] = {}
        self._tasks: list[asyncio.Task[None]] = []

    async def come(self) -> None:
        """Join, load the page, and see the robot."""
        begin_s = time.perf_counter()
        form = f"name={quote(self.name)}&code={quote(self.job.code)}&password="
        await self._answer("POST", "/join", form.encode())
        await self._answer("GET", "/")  # sent there by the form, and on to the robot
        document = f"/d/{self.job.document}"
        page = (await self._answer("GET", document)).decode()
        base = _found(_BASE, page)
        roots = [one for one in _NAMED.findall(page) if one.startswith("/")]
        await self._load(roots)
        self._keep(self._control())
        client = self._fetched(f"{base}viser/client.zst")  # asked for early, and the largest
        texts = self._fetched(f"{base}i18n/en.json")
        scene = self._fetched(f"{document}/viser/")
        editor = asyncio.create_task(self._editor(base, client))
        await self._load(base + one for one in _LATER)
        await self._load(_NAMED.findall((await scene).decode()))
        await asyncio.gather(client, texts)
        self._keep(self._view())
        await self._state.wait()
        self.state_s = time.perf_counter() - begin_s
        await self._scene.wait()
        self.there_s = time.perf_counter() - begin_s
        await editor
        self.editor_s = time.perf_counter() - begin_s

    async def _editor(self, base: str, client: asyncio.Task[bytes]) -> None:
        """Load what waits for the 3D view, but not for ever."""
        begin_s = time.perf_counter()
        await asyncio.wait({client}, timeout=_CLIENT_PATIENCE_S)
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(self._scene.wait(), _VIEW_PATIENCE_S)
        waited_s = time.perf_counter() - begin_s
        await asyncio.sleep(0 if waited_s < _SLOW_S else min(waited_s / 2, _COURTESY_S))
        await self._load(base + one for one in _IDLE)

    def drop(self) -> None:
        """End all lanes, as a browser does that changes its network."""
        for writer in self._lanes.values():
            writer.transport.abort()

    def forget(self) -> None:
        """Begin to count anew."""
        self.came = 0
        self.frames_s.clear()
        self.views.clear()

    def back_after(self, restored_s: float) -> float | None:
        """Seconds until its 3D view moved at the rate that is asked, and it was told of now."""
        slots = sorted({int(one / _SLOT_S) for one in self.frames_s if one >= restored_s})
        second = int(1 / _SLOT_S)
        steady = next(
            (
                one * _SLOT_S
                for one, later in zip(slots, slots[_LIVE_HZ - 1 :], strict=False)
                if later - one <= second
            ),
            None,
        )
        fresh = next(
            (at for at, age_s in self.views if at >= restored_s and age_s < _FRESH_S), None
        )
        return None if steady is None or fresh is None else max(steady, fresh) - restored_s

    # HTTP

    async def _load(self, addresses: Iterable[str]) -> None:
        """Fetch these and what the modules among them import."""
        wanted = [one for one in addresses if one not in self._known]
        bodies = await asyncio.gather(*map(self._fetched, wanted))
        imported = [
            _beside(address, name)
            for address, body in zip(wanted, bodies, strict=True)
            if address.endswith(".js")
            for name in _IMPORTED.findall(body.decode())
        ]
        if imported:
            await self._load(dict.fromkeys(imported))

    def _fetched(self, address: str) -> asyncio.Task[bytes]:
        if address not in self._known:
            self._known[address] = asyncio.create_task(self._answer("GET", address))
        return self._known[address]

    async def _answer(self, method: str, path: str, body: bytes = b"") -> bytes:
        async with self._slots:
            while self._free:
                # One that was kept may be closed at its other end by now: then another is taken.
                with contextlib.suppress(ConnectionError, EOFError):
                    return await self._exchange(self._free.pop(), method, path, body)
            return await self._exchange(await self._connected(), method, path, body)

    async def _exchange(
        self,
        ends: tuple[asyncio.StreamReader, asyncio.StreamWriter],
        method: str,
        path: str,
        body: bytes,
    ) -> bytes:
        reader, writer = ends
        form = "Content-Type: application/x-www-form-urlencoded\r\n" if body else ""
        head = (
            f"{method} {path} HTTP/1.1\r\n{self._common()}Accept: text/html,*/*\r\n"
            f"Accept-Encoding: {_ENCODINGS}\r\nContent-Length: {len(body)}\r\n{form}\r\n"
        )
        writer.write(head.encode() + body)
        told = await reader.readuntil(b"\r\n\r\n")
        lines = [line.partition(":") for line in told.decode("latin-1").split("\r\n")[1:]]
        fields = {name.lower(): value.strip() for name, _, value in lines}
        assert told[9:12] in {b"200", b"303"}, told
        content = await reader.readexactly(int(fields.get("content-length", 0)))
        self.came += len(told) + len(content)
        given = [one.split(";")[0] for name, _, one in lines if name.lower() == "set-cookie"]
        self.cookie = next((one.strip() for one in given if not one.endswith('=""')), self.cookie)
        if fields.get("connection") == "close":
            writer.close()
        else:
            self._free.append((reader, writer))
        return gzip.decompress(content) if fields.get("content-encoding") == "gzip" else content

    def _common(self) -> str:
        address = f"{self.job.host}:{self.job.port}"
        cookie = f"Cookie: {self.cookie}\r\n" if self.cookie else ""
        return f"Host: {address}\r\nOrigin: http://{address}\r\n{cookie}"

    async def _connected(self) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        return await asyncio.open_connection(self.job.host, self.job.port, limit=1 << 22)

    # Lanes

    def _keep(self, lane: Coroutine[None, None, None]) -> None:
        self._tasks.append(asyncio.create_task(lane))

    async def _control(self) -> None:
        document = self.job.document
        attempts = 0

        def greet() -> tuple[str, ...]:
            told = ({"type": "watch", "document": document, "request": 1},)
            return (*map(json.dumps, told), json.dumps({"type": "follow", "following": True}))

        def take(body: bytes) -> None:
            nonlocal attempts
            attempts = 0
            now_s = time.time()  # noqa: TID251 - of both processes
            if len(body) == _VIEW_BYTES and body[0] == 2:
                minute_s, ms, *_ = _VIEW.unpack_from(body, 8)
                age_s = (now_s - (minute_s * 60 + ms / 1000)) % 86_400
                self.views.append((now_s, min(age_s, 86_400 - age_s)))
            elif body.startswith(b'{"type":"done"'):
                self._state.set()

        while True:
            await self._lane("/control", "", greet(), take, _GREETING_S)
            await asyncio.sleep(RETRY_S[min(attempts, len(RETRY_S) - 1)])
            attempts += 1

    async def _view(self) -> None:
        def take(_: bytes) -> None:
            self.frames_s.append(time.time())  # noqa: TID251 - of both processes
            self._scene.set()

        while True:
            path = f"/d/{self.job.document}/viser"
            await self._lane(path, "viser-v1.1.1", (), take, _SCENE_OPENS_S)
            await asyncio.sleep(_SCENE_RETRY_S)

    async def _lane(
        self,
        path: str,
        protocol: str,
        greeting: tuple[str, ...],
        take: Callable[[bytes], None],
        opens_s: float,
    ) -> None:
        """A websocket until it ends."""
        with contextlib.suppress(OSError, EOFError, TimeoutError):
            async with asyncio.timeout(opens_s):
                reader, writer = await self._connected()
                self._lanes[path] = writer
                key = b64encode(os.urandom(16)).decode()
                more = f"Sec-WebSocket-Protocol: {protocol}\r\n" if protocol else ""
                writer.write(
                    f"GET {path} HTTP/1.1\r\n{self._common()}Connection: Upgrade\r\n"
                    "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                    f"Sec-WebSocket-Key: {key}\r\n{more}\r\n".encode()
                )
                head = await reader.readuntil(b"\r\n\r\n")
                assert head[9:12] == b"101", head
            for line in greeting:
                writer.write(_masked(0x81, line.encode()))
            await self._read(reader, writer, take)
        self.lost += 1

    async def _read(
        self,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
        take: Callable[[bytes], None],
    ) -> None:
        while True:
            first, length = await reader.readexactly(2)
            if length >= 126:
                wide = 2 if length == 126 else 8
                length = int.from_bytes(await reader.readexactly(wide), "big")
            body = await reader.readexactly(length)
            self.came += length + 4
            if first & 15 == _PING:
                writer.write(_masked(0x80 | _PONG, body))
            elif first & 15 == _CLOSE:
                writer.transport.abort()
                return
            else:
                take(body)


def _found(pattern: re.Pattern[str], text: str) -> str:
    found = pattern.search(text)
    assert found, "the page names no files"
    return found[0]


def _beside(address: str, name: str) -> str:
    if name.startswith("vendor/"):
        return _found(_BASE, address) + name
    return posixpath.normpath(posixpath.join(posixpath.dirname(address), name))


def _masked(first: int, payload: bytes) -> bytes:
    assert len(payload) < 126
    return bytes((first, 0x80 | len(payload), 0, 0, 0, 0)) + payload


def _say(**told: object) -> None:
    sys.stdout.write(json.dumps(told) + "\n")
    sys.stdout.flush()


def _seen(browsers: list[Browser], for_s: float) -> dict[str, object]:
    """What came in that time: the rate of each counts pictures that a screen can show apart."""
    return {
        "hz": [len({int(at / _SLOT_S) for at in one.frames_s}) / for_s for one in browsers],
        "bytes_per_s": [one.came / for_s for one in browsers],
        "ages_s": [age_s for one in browsers for _, age_s in one.views],
    }


async def _run(job: Job) -> None:
    browsers = [Browser(job, name) for name in job.names]
    await asyncio.gather(*(one.come() for one in browsers))
    _say(
        state_s=[one.state_s for one in browsers],
        there_s=[one.there_s for one in browsers],
        editor_s=[one.editor_s for one in browsers],
        came=[one.came for one in browsers],
    )
    while line := await asyncio.to_thread(sys.stdin.readline):
        word, _, number = line.strip().partition(" ")
        for one in browsers if word != "back" else ():
            one.forget()
        if word == "look":
            await asyncio.sleep(float(number))
            _say(**_seen(browsers, float(number)))
        elif word == "drop":
            for one in browsers:
                one.drop()
        elif word == "back":
            _say(
                back_s=[one.back_after(float(number)) for one in browsers],
                lost=sum(one.lost for one in browsers),
            )


if __name__ == "__main__":
    asyncio.run(_run(Job(**json.loads(sys.argv[1]))))
