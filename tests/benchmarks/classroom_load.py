"""Many browsers of a class in one process, which only counts what comes: `python -m ... JOB`.

A sample of the control lanes is read: the presenter's view says in its numbers when it was sent.
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
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable

_BUFFER = bytearray(1 << 20)
_VIEW = struct.Struct("<9f")
_SAMPLED = 10
"""Of so many control lanes one is read."""
_SCENE = "viser-v1.1.1"


@dataclass(frozen=True)
class Job:
    """What to do: come to a class with these cookies, and look for so long."""

    host: str
    port: int
    document: str
    """Empty: another server's, whose only lane is that of the 3D view."""
    cookies: list[str]
    settle_s: float
    window_s: float
    base: str = ""
    """The path below which the class is, without a slash at its end."""
    topic: str = ""
    """What each hears on a data lane; empty: nothing."""


@dataclass
class Lane:
    """A websocket of one browser."""

    socket: socket.socket
    is_scene: bool
    is_read: bool
    came: int = 0
    arrivals: int = 0
    held: bytearray = field(default_factory=bytearray)
    built_s: list[float] = field(default_factory=list[float])
    """When it was told of a run, from its first one, s since the epoch; of lanes that are read."""


class Crowd:
    """All lanes of all browsers."""

    def __init__(self, job: Job) -> None:
        self._job, self.lanes = job, list[Lane]()
        self._selector = selectors.EpollSelector()
        self.ages_ms: list[float] = []

    def come(self) -> float:
        """Open all lanes; gives the seconds until the last of them had its first bytes."""
        begin_s = time.perf_counter()
        for number, cookie in enumerate(self._job.cookies):
            if document := self._job.document:
                self._open("/control", cookie, is_read=number % _SAMPLED == 0)
                self._open(f"/d/{document}/viser", cookie, scene=True)
                if self._job.topic:
                    self._open("/data", cookie)
            else:
                self._open("/", cookie, scene=True)
        while not all(lane.came for lane in self.lanes):
            self._read(0.5)
        return time.perf_counter() - begin_s

    def look(self, for_s: float) -> None:
        """Read what comes."""
        end_s = time.perf_counter() + for_s
        while (left_s := end_s - time.perf_counter()) > 0:
            self._read(left_s)

    def forget(self) -> None:
        """Begin to count anew."""
        for lane in self.lanes:
            lane.came = lane.arrivals = 0
        self.ages_ms.clear()

    def _open(self, path: str, cookie: str, *, is_read: bool = False, scene: bool = False) -> None:
        opened, came = open_lane(self._job, path, cookie)
        lane = Lane(opened, scene, is_read)
        lane.held += came
        lane.came = len(lane.held)
        self._selector.register(opened, selectors.EVENT_READ, lane)
        self.lanes.append(lane)

    def _read(self, timeout_s: float) -> None:
        for key, _ in self._selector.select(timeout_s):
            lane: Lane = key.data
            count = lane.socket.recv_into(_BUFFER)
            if count == 0:
                raise EOFError("the studio closed a lane")
            lane.came += count
            lane.arrivals += 1
            if lane.is_read:
                lane.held += memoryview(_BUFFER)[:count]
                self._take_frames(lane)

    def _take_frames(self, lane: Lane) -> None:
        now_s = time.time()  # noqa: TID251 - of both processes
        held = lane.held
        while len(held) >= 2:
            length, start = held[1] & 127, 2
            if length == 126:
                length, start = int.from_bytes(held[2:4], "big"), 4
            elif length == 127:
                length, start = int.from_bytes(held[2:10], "big"), 10
            if len(held) < start + length:
                return
            body = bytes(held[start : start + length])
            del held[: start + length]
            if len(body) == 60 and body[0] == 2:
                minute_s, ms, *_ = _VIEW.unpack_from(body, 8)
                self.ages_ms.append((now_s - (minute_s * 60 + ms / 1000) % 86_400) % 86_400 * 1e3)
            elif body.startswith(b'{"type":"built"'):
                lane.built_s.append(now_s)


def open_lane(job: Job, path: str, cookie: str) -> tuple[socket.socket, bytes]:
    """A websocket, with what a page says on it at first; and what came with its head."""
    opened = socket.create_connection((job.host, job.port), 60)
    key = base64.b64encode(os.urandom(16)).decode()
    lines = [
        f"GET {job.base}{path} HTTP/1.1",
        f"Host: {job.host}:{job.port}",
        f"Origin: http://{job.host}:{job.port}",
        f"Cookie: {cookie}",
        "Connection: Upgrade",
        "Upgrade: websocket",
        "Sec-WebSocket-Version: 13",
        f"Sec-WebSocket-Key: {key}",
        *([f"Sec-WebSocket-Protocol: {_SCENE}"] if path not in _LANES else []),
    ]
    opened.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
    head = bytearray()
    while b"\r\n\r\n" not in head:
        head += opened.recv(4096)
    assert b" 101 " in head.split(b"\r\n", 1)[0], head
    for said in _LANES.get(path, lambda _: ())(job):
        opened.sendall(_masked(json.dumps(said)))
    opened.setblocking(False)
    return opened, bytes(head.partition(b"\r\n\r\n")[2])


def _of_control(job: Job) -> tuple[dict[str, object], ...]:
    watch: dict[str, object] = {"type": "watch", "document": job.document}
    return watch, {"type": "follow", "following": True}


def _of_data(job: Job) -> tuple[dict[str, object], ...]:
    return ({"type": "subscribe", "subscription": 1, "topic": job.topic, "mode": "every"},)


_LANES: Final[dict[str, Callable[[Job], tuple[dict[str, object], ...]]]] = {
    "/control": _of_control,
    "/data": _of_data,
}
"""What is said first, by path; any other lane is that of a 3D view."""


def _masked(text: str) -> bytes:
    payload = text.encode()
    assert len(payload) < 126
    return bytes((0x81, 0x80 | len(payload), 0, 0, 0, 0)) + payload


def main(text: str) -> None:
    """Come, say so, look, and print what was seen."""
    job = Job(**json.loads(text))
    crowd = Crowd(job)
    joined_s = crowd.come()
    sys.stdout.write(json.dumps({"joined_s": joined_s}) + "\n")
    sys.stdout.flush()
    crowd.look(job.settle_s)
    crowd.forget()
    window_s = time.time()  # noqa: TID251 - of both processes
    cpu_s = time.process_time()
    begin_s = time.perf_counter()
    crowd.look(job.window_s)
    took_s = time.perf_counter() - begin_s
    scenes = [lane for lane in crowd.lanes if lane.is_scene]
    seen = {
        "bytes_per_s": sum(lane.came for lane in crowd.lanes) / took_s / len(scenes),
        "hz": sorted(lane.arrivals for lane in scenes)[len(scenes) // 2] / took_s,
        "ages_ms": sorted(crowd.ages_ms),
        "built_s": [lane.built_s for lane in crowd.lanes if lane.is_read],
        "since_s": window_s,
        "cpu_s": (time.process_time() - cpu_s) / took_s,
    }
    sys.stdout.write(json.dumps(seen) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
