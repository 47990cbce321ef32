"""Follows one sample from Zenoh to a browser's socket: which forms it takes, and what holds it.

`python -m tests.support.house_walks` prints what is found, beside the files of the walks.
"""

from __future__ import annotations

import asyncio
import sys
import threading
from collections import deque
from collections.abc import Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

from studio.live.topics.browsers import BrowserTopics
from studio.live.topics.frames import Chunk, Tick
from studio.outlet import GATE_BYTES
from studio.protocol.roles import Role, Visitor
from studio.protocol.subscriptions import Subscribe
from studio.ros.qos import QoSProfile
from studio.server.bulk_lane import BulkKeys
from studio.server.data_lane import DataLane
from tests.support.topic_worlds import zenoh_world
from tests.support.wire import PATIENCE_S, wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator
    from types import CodeType, FrameType

    from studio.server.websocket import Lane
    from tests.support.topic_worlds import World

_STUDIO: Final = str(Path(__file__).resolve().parents[2] / "studio")
_TOPIC: Final = "/followed"
_DEEP: Final = 5
_MANY: Final = (list, deque, dict, set)


class Follower:
    """Looks, whenever a function of the studio returns, for a text that a sample has in it.

    Attributes:
        forms: Each run of bytes that the text was in, and the function that was seen with it first.
        buffers: Attributes of objects that held the sample in a collection, on its way or while
            it waited.
    """

    def __init__(self, marker: bytes) -> None:
        self._marker = marker
        self._found: dict[int, tuple[str, object]] = {}
        self.buffers: set[str] = set()
        self.is_on = False

    @property
    def forms(self) -> list[str]:
        """In the order in which they were made."""
        return [where for where, _ in self._found.values()]

    @contextmanager
    def watching(self) -> Generator[None]:
        """Watch this thread, and all that begin meanwhile."""
        threading.setprofile(self._look)
        sys.setprofile(self._look)
        try:
            yield
        finally:
            sys.setprofile(None)
            threading.setprofile(None)

    @contextmanager
    def looking_away(self) -> Generator[None]:
        """What this thread does meanwhile is no part of the way."""
        sys.setprofile(None)
        try:
            yield
        finally:
            sys.setprofile(self._look)

    def _look(self, frame: FrameType, event: str, result: object) -> None:
        if not self.is_on or event != "return" or not _is_studio(frame.f_code):
            return
        where = frame.f_code.co_qualname
        for value in (*frame.f_locals.values(), result):
            self._has(value, where, 0)
            self._look_into(value, where)

    def _look_into(self, value: object, where: str) -> None:
        """Note which collections of an object hold the sample."""
        if not type(value).__module__.startswith("studio.") or isinstance(value, (Tick, Chunk)):
            return
        for name, part in _attributes(value):
            if isinstance(part, _MANY) and self._has(cast("object", part), where, 0):
                self.buffers.add(f"{type(value).__name__}.{name.lstrip('_')}")

    def _has(self, value: object, where: str, depth: int) -> bool:
        if isinstance(value, (bytes, bytearray)):
            is_there = self._marker in value
            if is_there and id(value) not in self._found:
                self._found[id(value)] = where, value  # kept, so that no other gets its number
            return is_there
        if isinstance(value, memoryview):
            return self._has(value.obj, where, depth)
        if depth > _DEEP:
            return False
        holding = [self._has(part, where, depth + 1) for part in _parts(value)]  # all are looked at
        return any(holding)


def _is_studio(code: CodeType) -> bool:
    return code.co_filename.startswith(_STUDIO)


def _parts(value: Any) -> tuple[object, ...]:  # noqa: ANN401 - whatever functions have
    try:
        if isinstance(value, Mapping):
            return tuple(cast("Mapping[object, object]", value).values())
        if isinstance(value, (tuple, *_MANY)):
            return tuple(cast("tuple[object, ...]", value))
    except RuntimeError:  # another thread changes it just now: the next look sees it
        return ()
    if isinstance(value, (Tick, Chunk)):
        return tuple(part for _, part in _attributes(value))
    return ()


def _attributes(value: object) -> Iterator[tuple[str, object]]:
    yield from tuple(getattr(value, "__dict__", {}).items())
    for kind in type(value).__mro__:
        for name in getattr(kind, "__slots__", ()):
            if hasattr(value, name):
                yield name, getattr(value, name)


class _Socket:
    """Keeps what is written; while it is slow, it has more than a lane writes to."""

    def __init__(self) -> None:
        self.written: list[bytes] = []
        self.is_slow = False

    def write_frame(self, frame: bytes) -> None:
        self.written.append(frame)

    def pending_bytes(self) -> int:
        return GATE_BYTES + 1 if self.is_slow else 0


class _Lane:
    """A websocket's end that leads to a `_Socket`."""

    def __init__(self) -> None:
        self.socket = _Socket()
        self.resume: Callable[[], object] = lambda: None

    def on_drain(self, resume: Callable[[], object]) -> None:
        self.resume = resume

    def close(self, code: int) -> None:
        raise AssertionError(code)


def follow_sample(endpoint: str, *, slow: bool = False, size: int = 10) -> Follower:
    """Follow one of so many characters to a browser, which may take nothing at first.

    Args:
        endpoint: Of a router.
        slow: Whether the browser takes nothing until the sample waits for it.
        size: Of the text around which there is a message.
    """
    marker = "marked" + size * "."
    follower = Follower(marker.encode())
    with follower.watching(), zenoh_world(endpoint) as world:
        asyncio.run(_followed(world, follower, marker, slow=slow))
    return follower


async def _followed(world: World, follower: Follower, marker: str, *, slow: bool) -> None:
    speaker = world.speaker(_TOPIC, QoSProfile(depth=10))
    end = _Lane()
    lane, topics = (
        DataLane(cast("Lane", end), BulkKeys(), Visitor(Role.PRESENTER)),
        BrowserTopics(world.source),
    )
    topics.attach(lane)
    topics.carry_out(lane, Subscribe(subscription=1, topic=_TOPIC, mode="every"))
    written = end.socket.written
    await _until(lambda: bool(world.depths(_TOPIC)))
    with follower.looking_away():
        speaker.say("first")
    await _until(lambda: any(b"first" in one for one in written))
    end.socket.is_slow = slow
    follower.is_on = True
    with follower.looking_away():
        speaker.say(marker)
    # Nobody takes it out of its queue before it was seen there: the loop stands still meanwhile.
    wait_until("it waits in a queue", lambda: bool(follower.buffers))
    if slow:
        await _until(lambda: "Backlog.all" in follower.buffers)
        end.socket.is_slow = False
        end.resume()
    await _until(lambda: any(marker.encode() in one for one in written))
    follower.is_on = False
    await topics.close()


async def _until(holds: Callable[[], bool]) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while not holds():  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.01)
