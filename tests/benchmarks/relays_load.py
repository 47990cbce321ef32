"""One browser at the studio and one at each relay, by one clock: `python -m ... JOB`.

What is marked is found again at each: a frame of the 3D view by its bytes, the presenter's view and
a message of a topic by the time of sending that they carry.
"""

from __future__ import annotations

import hashlib
import json
import selectors
import struct
import sys
import time
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from studio.live.topics.frames import FRAME_HEAD, MESSAGE_HEAD
from tests.benchmarks.classroom_load import Job, open_lane
from tests.benchmarks.data_browsers import Frames, websocket_head
from tests.benchmarks.relays_places import inside

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable

_VIEW: Final = struct.Struct("<9f")
_VIEW_BYTES: Final = 60
_BINARY: Final = 2
_BUFFER: Final = memoryview(bytearray(1 << 20))


@dataclass
class Place:
    """What one browser saw: when each marked thing came, s since the epoch."""

    came_s: dict[str, dict[str, float]] = field(default_factory=dict[str, dict[str, float]])
    """By kind and mark."""

    def note(self, kind: str, mark: str, at_s: float) -> None:
        """It came; the first time counts."""
        self.came_s.setdefault(kind, {}).setdefault(mark, at_s)


class Sampler:
    """Their sockets, read in turn."""

    def __init__(self) -> None:
        self._selector = selectors.EpollSelector()
        self.places: list[Place] = []
        self._now_s = 0.0

    def come(self, job: Job, namespace: str) -> None:
        """Open the lanes of one more browser."""
        place = Place()
        self.places.append(place)
        takes = {
            "/control": partial(self._take_control, place),
            f"/d/{job.document}/viser": partial(self._take_scene, place),
            "/data": partial(self._take_data, place),
        }
        with inside(namespace):
            for path, take in takes.items():
                self._open(job, path, take)

    def look(self, for_s: float) -> None:
        """Read what comes."""
        end_s = time.perf_counter() + for_s
        while (left_s := end_s - time.perf_counter()) > 0:
            for key, _ in self._selector.select(left_s):
                one: socket.socket = key.fileobj  # type: ignore[assignment]
                count = one.recv_into(_BUFFER)
                self._now_s = time.time()  # noqa: TID251 - of all processes
                if count == 0:
                    raise EOFError("a lane was closed")
                frames: Frames = key.data
                frames.feed(_BUFFER[:count])

    def forget(self) -> None:
        """Begin to note anew."""
        for place in self.places:
            place.came_s.clear()

    def _open(self, job: Job, path: str, take: Callable[[memoryview | bytearray], None]) -> None:
        opened, came = open_lane(job, path, job.cookies[0])

        def taken(opcode: int, body: memoryview | bytearray) -> None:
            if opcode == _BINARY:
                take(body)

        frames = Frames(websocket_head, taken, None)
        frames.feed(memoryview(came))
        self._selector.register(opened, selectors.EVENT_READ, frames)

    def _take_control(self, place: Place, body: memoryview | bytearray) -> None:
        if len(body) == _VIEW_BYTES and body[0] == _BINARY:
            minute_s, ms, *_ = _VIEW.unpack_from(body, 8)
            place.note("view", repr(minute_s * 60 + ms / 1000), self._now_s)

    def _take_scene(self, place: Place, body: memoryview | bytearray) -> None:
        place.note("3D", hashlib.blake2b(body, digest_size=16).hexdigest(), self._now_s)

    def _take_data(self, place: Place, body: memoryview | bytearray) -> None:
        _, count, _ = FRAME_HEAD.unpack_from(body)
        at = FRAME_HEAD.size
        for _ in range(count):
            _, length, _, sent_ns, _ = MESSAGE_HEAD.unpack_from(body, at)
            place.note("topic", repr(sent_ns / 1e9), self._now_s)
            at += length + MESSAGE_HEAD.size + 7 & ~7


def ages_ms(kind: str, place: Place) -> list[float]:
    """How old the marked things of a kind were when they came; none of the 3D view's frames."""
    if kind == "3D":
        return []
    came = place.came_s.get(kind, {})
    day_s = 86_400  # of a view, the time of the day is known alone
    return [(at_s - float(mark)) % day_s * 1e3 for mark, at_s in came.items()]


def added_ms(kind: str, direct: Place, relayed: Place) -> list[float]:
    """How much later than at the studio they came by the relay."""
    there = direct.came_s.get(kind, {})
    here = relayed.came_s.get(kind, {})
    return [(at_s - there[mark]) * 1e3 for mark, at_s in here.items() if mark in there]


def main(text: str) -> None:
    """Come, say so, look, and print what was seen."""
    wanted: dict[str, Any] = json.loads(text)
    sampler = Sampler()
    for one in wanted["places"]:
        sampler.come(Job(**one["job"]), one["namespace"])
    sys.stdout.write("{}\n")
    sys.stdout.flush()
    sampler.look(wanted["settle_s"])
    sampler.forget()
    sampler.look(wanted["window_s"])
    direct, *relayed = sampler.places
    seen = {
        kind: {
            "direct_ms": ages_ms(kind, direct),
            "relayed_ms": [age for one in relayed for age in ages_ms(kind, one)],
            "added_ms": [age for one in relayed for age in added_ms(kind, direct, one)],
        }
        for kind in ("view", "3D", "topic")
    }
    sys.stdout.write(json.dumps(seen) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
