"""The bulk lane: large messages on one streamed answer, beside a browser's data lane.

A browser takes bytes from a streamed answer several times as fast as from a websocket. It sends
commands on `/data` as always, also `{"type": "ask_bulk"}`, and receives its key: `{"type":
"bulk_key", "key": ...}`. Then it opens `GET /bulk?key=...`, whose body does not end: frames as
those of the data lane (see `studio.live.topics.frames.py`), each after its length as four bytes,
little-endian. The first large message of a channel still comes on the data lane, where the number
of the channel is sent; those that follow come here, while this is open, and on `/data` afterwards.
"""

from __future__ import annotations

import asyncio
import secrets
import struct
from typing import TYPE_CHECKING, Final, Protocol

from starlette.responses import Response

from studio.errors import UnknownLaneError
from studio.live.topics.frames import frame_parts
from studio.outlet import GATE_BYTES
from studio.server.backlog import Backlog
from studio.server.http_protocol import connection_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import Receive, Scope, Send

    from studio.live.topics.frames import Chunk, Tick
    from studio.server.http_protocol import StudioConnection

_LENGTH: Final = struct.Struct("<I")
_HEADERS: Final = (
    (b"content-type", b"application/octet-stream"),
    (b"connection", b"close"),
    (b"x-accel-buffering", b"no"),  # a proxy that waits for the end would wait for ever
)


class BulkLane:
    """One streamed answer; what cannot be sent yet waits in a bounded backlog."""

    def __init__(self, connection: StudioConnection) -> None:
        self._connection = connection
        self._backlog = Backlog()
        self._channels: frozenset[int] = frozenset()
        connection.on_drain = self._resume

    def take(self, tick: Tick) -> Tick:
        """Send what is large; gives what is to go by the data lane."""
        rest = tick.without(self._channels)
        if rest is not tick:
            for chunk in tick.chunks:
                if chunk.channel in self._channels:
                    self._post(chunk)
        if not rest.large <= self._channels:
            self._channels |= rest.large
        return rest

    def forget(self, channel: int) -> None:
        """A channel is announced again: its next message goes by the data lane, after that."""
        self._channels -= {channel}

    def leave(self) -> tuple[Chunk, ...]:
        """Send nothing more; gives what was kept."""
        self._channels = frozenset()
        return self._backlog.take_all()

    def _post(self, chunk: Chunk) -> None:
        if self._backlog or not self._is_open():
            self._backlog.add((chunk,))
        else:
            self._write(chunk)

    def _resume(self) -> None:
        while self._backlog and self._is_open():
            self._write(self._backlog.pop())

    def _is_open(self) -> bool:
        return self._connection.pending_bytes() <= GATE_BYTES

    def _write(self, chunk: Chunk) -> None:
        parts = frame_parts((chunk,), self._backlog.dropped)
        self._connection.write_chunk((_LENGTH.pack(sum(map(len, parts))), *parts))


class SendsBulk(Protocol):
    """A data lane, which hands large messages to a bulk lane."""

    def open_bulk(self, bulk: BulkLane, end: Callable[[], object]) -> None:
        """Send what is large by this one from now on; `end` ends it."""
        ...

    def close_bulk(self, bulk: BulkLane) -> None:
        """Send by it no more."""
        ...


class BulkAnswer(Response):
    """The answer whose body is a bulk lane."""

    def __init__(self, lane: SendsBulk) -> None:
        super().__init__()
        self._lane = lane

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Stream until either side goes, or the data lane ends."""
        await send({"type": "http.response.start", "status": 200, "headers": list(_HEADERS)})
        connection = connection_of(scope)
        bulk = BulkLane(connection)
        leaving = asyncio.create_task(_left(receive))
        self._lane.open_bulk(bulk, leaving.cancel)
        try:
            await asyncio.wait({leaving})
        finally:
            leaving.cancel()
            connection.on_drain = None
            self._lane.close_bulk(bulk)
        if connection.pending_bytes():
            connection.abort()  # who reads slowly would be waited for
            await _left(receive)
        else:
            await send({"type": "http.response.body", "body": b"", "more_body": False})


async def _left(receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass


class BulkKeys:
    """Knows the data lane of each key; a bulk lane sends only what that one subscribed."""

    def __init__(self) -> None:
        self._lanes: dict[str, SendsBulk] = {}

    def key_of(self, lane: SendsBulk) -> str:
        """Return its key, always the same."""
        for key, one in self._lanes.items():
            if one is lane:
                return key
        key = secrets.token_urlsafe(24)
        self._lanes[key] = lane
        return key

    def lane_of(self, key: str) -> SendsBulk:
        """Return the lane whose key this is.

        Raises:
            UnknownLaneError: It is no open lane's.
        """
        if key not in self._lanes:
            raise UnknownLaneError
        return self._lanes[key]

    def forget(self, lane: SendsBulk) -> None:
        """Remove a closed lane."""
        self._lanes = {key: one for key, one in self._lanes.items() if one is not lane}
