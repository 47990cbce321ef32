"""Browsers of a benchmark, many in one process: sockets that take frames apart and count.

`python -m tests.benchmarks.data_browsers` reads one `Job` as a line of JSON, prints `ready` when
all hands are shaken, measures from the line `begin` to the line `end`, and prints its `Counted`.
What comes goes into one buffer for all; of a large message only the beginning is looked at.
"""

from __future__ import annotations

import base64
import json
import os
import selectors
import socket
import struct
import sys
import time
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.live.topics.frames import FRAME_HEAD, MESSAGE_HEAD

if TYPE_CHECKING:
    from collections.abc import Callable

STAMP_AT: Final = 8
"""Where the text of a `std_msgs/msg/String` begins in its CDR: with the time it was sent at."""
STAMP_DIGITS: Final = 20
_BEGINNING_BYTES: Final = 256
_BUFFER_BYTES: Final = 1 << 22
HEAD_MAX: Final = 16
_BULK_HEAD: Final = 4
_FOXGLOVE_HEAD: Final = 13
_FOXGLOVE_MESSAGE: Final = 1
_BINARY: Final = 2
_DELAYS_MAX: Final = 200_000
_SIP_S: Final = 0.05


@dataclass(frozen=True)
class Job:
    """Where to hear, as whom, and how many browsers do."""

    kind: str
    """Whose frames they are: `studio`, `naive` or `foxglove`."""
    port: int
    browsers: int
    path: str = "/data"
    headers: str = ""
    words: tuple[str, ...] = ()
    """What each says first."""
    large: bool = False
    """Whether each frame is one large message: of it only the beginning is kept."""
    sips_bytes_per_s: int = 0
    """How slowly they read; 0: as fast as they can."""


@dataclass
class Counted:
    """What came between `begin` and `end`."""

    messages: list[int] = field(default_factory=list[int])
    """Of each browser."""
    delays_ms: list[float] = field(default_factory=list[float])
    """From when it was sent to its last byte."""
    load: float = 0.0
    """What this process took, in cores."""
    hung_up: int = 0
    """On how many browsers the server hung up."""


class Head(NamedTuple):
    """What the beginning of a frame says."""

    size: int
    """Of the head itself."""
    length: int
    """Of the body behind it."""
    opcode: int = _BINARY


def websocket_head(data: memoryview | bytearray, at: int) -> Head | None:
    """Of a websocket's frame (RFC 6455 section 5.2); None while it is not all there."""
    have = len(data) - at
    short = data[at + 1] & 127 if have > 1 else 0
    size = {126: 4, 127: 10}.get(short, 2)
    if have < size:
        return None
    length = short if size == 2 else int.from_bytes(data[at + 2 : at + size], "big")
    return Head(size, length, data[at] & 15)


def chunk_head(data: memoryview | bytearray, at: int) -> Head | None:
    """Of a chunk (RFC 9112 section 7.1), whose body ends with a new line of its own."""
    line, ended, _ = bytes(data[at : at + HEAD_MAX]).partition(b"\r\n")
    return Head(len(line) + 2, int(line, 16) + 2) if ended else None


class Frames:
    """Takes frames apart as bytes come, wherever those are cut."""

    def __init__(
        self,
        read_head: Callable[[memoryview | bytearray, int], Head | None],
        take: Callable[[int, memoryview | bytearray], None],
        most_bytes: int | None,
    ) -> None:
        self._read_head, self._take, self._most_bytes = read_head, take, most_bytes
        self._begun, self._body = bytearray(), bytearray()
        self._opcode = self._length = self._missing = 0

    def feed(self, came: memoryview) -> None:
        """Take in what came."""
        at, end = 0, len(came)
        while at < end:
            if self._missing:
                at = self._go_on(came, at)
            elif self._begun or end - at < HEAD_MAX:  # a head may be cut
                self._begun.append(came[at])
                at += 1
                self._begin(self._begun, 0)
            else:
                at = self._begin(came, at)

    def _begin(self, data: memoryview | bytearray, at: int) -> int:
        """Read a head if all of it is there; give where the body begins."""
        head = self._read_head(data, at)
        if head is None:
            return at
        self._opcode, self._length, self._missing = head.opcode, head.length, head.length
        self._begun, self._body = bytearray(), bytearray()
        return at + head.size

    def _go_on(self, came: memoryview, at: int) -> int:
        part = came[at : at + self._missing]
        self._missing -= len(part)
        if len(part) == self._length:
            self._take(self._opcode, part)
        else:
            most = self._length if self._most_bytes is None else self._most_bytes
            self._body += part[: max(0, most - len(self._body))]
            if not self._missing:
                self._take(self._opcode, self._body)
        return at + len(part)


class Browser:
    """One browser's sockets, and what came on them since it was asked last."""

    def __init__(self, job: Job, delays_ms: list[float]) -> None:
        self.count = 0
        self._delays_ms = delays_ms
        first = _shaken(job)
        takes = {
            "studio": self._take_studio,
            "naive": self._take_naive,
            "foxglove": self._take_foxglove,
        }
        most_bytes = _BEGINNING_BYTES if job.large else None
        self.sockets = {first: Frames(websocket_head, takes[job.kind], most_bytes)}
        if job.large and job.kind == "studio":
            bulk = _bulk_lane(job, first)
            self.sockets[bulk] = Frames(chunk_head, self._take_bulk, most_bytes)
        for words in job.words:
            first.sendall(_text_frame(words.encode()))
        for one in self.sockets:
            one.setblocking(False)

    def read(self, one: socket.socket, buffer: memoryview) -> bool:
        """Take in what waits, as much as there is room for; False when the server hung up."""
        try:
            length = one.recv_into(buffer)
        except ConnectionResetError:
            return False
        self.sockets[one].feed(buffer[:length])
        return length > 0

    def _take_bulk(self, opcode: int, body: memoryview | bytearray) -> None:
        self._take_studio(opcode, body[_BULK_HEAD:])

    def _take_naive(self, opcode: int, body: memoryview | bytearray) -> None:
        if opcode == _BINARY:
            self._came(body, 0)

    def _take_foxglove(self, opcode: int, body: memoryview | bytearray) -> None:
        if opcode == _BINARY and body[0] == _FOXGLOVE_MESSAGE:
            self._came(body, _FOXGLOVE_HEAD)

    def _take_studio(self, opcode: int, body: memoryview | bytearray) -> None:
        if opcode != _BINARY:
            return
        _, count, _ = FRAME_HEAD.unpack_from(body)
        at = FRAME_HEAD.size
        for _ in range(count):
            _, length, *_ = MESSAGE_HEAD.unpack_from(body, at)
            at += MESSAGE_HEAD.size
            self._came(body, at)
            at += (length + MESSAGE_HEAD.size + 7 & ~7) - MESSAGE_HEAD.size

    def _came(self, body: memoryview | bytearray, at: int) -> None:
        begin = at + STAMP_AT
        sent_ns = int(bytes(body[begin : begin + STAMP_DIGITS]))
        self.count += 1
        if len(self._delays_ms) < _DELAYS_MAX:
            self._delays_ms.append((time.monotonic_ns() - sent_ns) / 1e6)


def _shaken(job: Job) -> socket.socket:
    key = base64.b64encode(os.urandom(16)).decode()
    return _asked(
        job,
        job.path,
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        f"Sec-WebSocket-Key: {key}\r\n",
        b" 101 ",
    )


def _bulk_lane(job: Job, lane: socket.socket) -> socket.socket:
    """The studio's bulk lane of a data lane that was opened just now."""
    lane.sendall(_text_frame(json.dumps({"type": "ask_bulk"}).encode()))
    head = lane.recv(2, socket.MSG_WAITALL)
    assert head[1] < 126, "the key is told in a short text"
    key = json.loads(lane.recv(head[1], socket.MSG_WAITALL))["key"]
    return _asked(job, f"/bulk?key={key}", "", b" 200 ")


def _asked(job: Job, path: str, headers: str, status: bytes) -> socket.socket:
    made = socket.create_connection(("127.0.0.1", job.port))
    host = f"127.0.0.1:{job.port}"
    made.sendall(f"GET {path} HTTP/1.1\r\nHost: {host}\r\n{headers}{job.headers}\r\n".encode())
    head = b""
    while not head.endswith(b"\r\n\r\n"):  # by one byte, so that none of a frame is taken
        byte = made.recv(1)
        assert byte, head
        head += byte
    assert status in head, head
    return made


def _text_frame(payload: bytes) -> bytes:
    """A text from a browser, masked with zeros."""
    length = len(payload)
    size = bytes((0x80 | length,)) if length < 126 else b"\xfe" + struct.pack(">H", length)
    return b"\x81" + size + bytes(4) + payload


def read_all(job: Job) -> None:
    """Read as fast as it comes, and answer what is asked on standard input."""
    counted = Counted()
    browsers = [Browser(job, counted.delays_ms) for _ in range(job.browsers)]
    buffer = memoryview(bytearray(_BUFFER_BYTES))
    window = _Window(browsers, counted)
    with selectors.DefaultSelector() as selector:
        for browser in browsers:
            for one in browser.sockets:
                selector.register(one, selectors.EVENT_READ, partial(browser.read, one))
        selector.register(sys.stdin, selectors.EVENT_READ, window.hear)
        say("ready")
        while not window.is_over:
            for key, _ in selector.select():
                if not key.data(buffer):
                    selector.unregister(key.fileobj)
                    counted.hung_up += 1
    say(json.dumps(asdict(counted)))


class _Window:
    """From the line `begin` to the line `end`."""

    def __init__(self, browsers: list[Browser], counted: Counted) -> None:
        self._browsers, self._counted = browsers, counted
        self._began = (0.0, 0.0)
        self.is_over = False

    def hear(self, _: memoryview) -> bool:
        """Take an order."""
        now = (time.perf_counter(), time.process_time())
        if sys.stdin.readline() == "begin\n":
            self._began = now
            self._counted.delays_ms.clear()
            for browser in self._browsers:
                browser.count = 0
        else:
            took_s, processor_s = now[0] - self._began[0], now[1] - self._began[1]
            self._counted.load = processor_s / took_s
            self._counted.messages = [browser.count for browser in self._browsers]
            self.is_over = True
        return True


def sip(job: Job) -> None:
    """Read slowly, until somebody ends it."""
    browsers = [Browser(job, []) for _ in range(job.browsers)]
    say("ready")
    mouthful = memoryview(bytearray(int(job.sips_bytes_per_s * _SIP_S)))
    while True:
        time.sleep(_SIP_S)
        for one in (each for browser in browsers for each in browser.sockets):
            try:
                one.recv_into(mouthful)
            except BlockingIOError:
                continue


def say(line: str) -> None:
    """Write a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    given = Job(**json.loads(sys.stdin.readline()))
    if given.sips_bytes_per_s:
        sip(given)
    else:
        read_all(given)
