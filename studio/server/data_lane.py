"""The data lane: a browser subscribes topics in JSON; samples go to it in ticks."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from pydantic import ValidationError

from studio.live.topics.frames import Tick
from studio.outlet import Outlet
from studio.protocol.subscriptions import (
    LANE_COMMANDS,
    AskBulk,
    BulkKey,
    NotSubscribed,
    SubscriptionView,
)
from studio.server.backlog import Backlog
from studio.server.commands import malformed
from studio.server.websocket import FrameTransport, binary_head, text_frame

if TYPE_CHECKING:
    from collections.abc import Callable

    from pydantic import BaseModel

    from studio.protocol.roles import Person
    from studio.protocol.subscriptions import LaneCommand
    from studio.server.bulk_lane import BulkKeys, BulkLane
    from studio.server.surface import SubscribesTopics
    from studio.server.websocket import Lane

_TOO_SLOW: Final = 1013
"""Close code `try again later`: the page connects again and subscribes all again."""
_COMMAND_LIMIT_BYTES: Final = 4_096
_TICK: Final = "tick"


class DataLane:
    """One browser's data lane, to which topics send their messages."""

    def __init__(self, lane: Lane, keys: BulkKeys, visitor: Person) -> None:
        self._lane, self._keys = lane, keys
        self.person = visitor.person
        self.sees = visitor.sees
        """Whether its person may look at a document."""
        self._backlog = Backlog()
        self._outlet = Outlet(FrameTransport(lane), on_hopeless=lambda: lane.close(_TOO_SLOW))
        self._bulk: BulkLane | None = None
        self._end_bulk: Callable[[], object] = lambda: None
        lane.on_drain(self._outlet.resume)

    def send(self, message: BaseModel, /) -> None:
        """Queue one JSON message."""
        if self._bulk is not None and isinstance(message, SubscriptionView):
            self._bulk.forget(message.channel)
        self._outlet.post(text_frame(message.model_dump_json().encode()))

    def take(self, tick: Tick, /) -> None:
        """Send what came; what cannot go now is kept as far as it is of worth."""
        rest = tick if self._bulk is None else self._bulk.take(tick)
        if rest.chunks:
            self._send(rest)

    def open_bulk(self, bulk: BulkLane, end: Callable[[], object]) -> None:
        """Send what is large by this one from now on; `end` ends it."""
        self._end_bulk()
        self._bulk, self._end_bulk = bulk, end
        if self._outlet.closed:  # while the answer was made, the browser left
            end()

    def close_bulk(self, bulk: BulkLane) -> None:
        """Send by it no more; what it kept goes by the data lane."""
        left = bulk.leave()
        if self._bulk is bulk:
            self._bulk, self._end_bulk = None, lambda: None
        if left:
            self.take(Tick(left))

    def _send(self, tick: Tick) -> None:
        if not self._outlet.holds_back and not self._backlog.dropped:
            if self._outlet.post(partial(tick.frame, binary_head), _TICK, late=self._late):
                return
            self._backlog.add(tick.chunks)
        else:
            self._backlog.add(tick.chunks)
            self._outlet.post(self._late, _TICK)

    async def serve(self, topics: SubscribesTopics) -> None:
        """Carry out commands until the browser leaves."""
        topics.attach(self)
        try:
            while (text := await self._lane.receive()) is not None:
                self._take_text(topics, text)
        finally:
            topics.detach(self)
            self._keys.forget(self)
            self._outlet.close()
            self._end_bulk()
            await self._lane.finish()

    def _take_text(self, topics: SubscribesTopics, text: bytes) -> None:
        if len(text) > _COMMAND_LIMIT_BYTES:
            self.send(NotSubscribed(subscription=0, reason="So long a command is not read."))
            return
        try:
            command = LANE_COMMANDS.validate_json(text)
        except ValidationError as error:
            self.send(NotSubscribed(subscription=0, reason=malformed("command", error)))
        else:
            self._carry_out(topics, command)

    def _carry_out(self, topics: SubscribesTopics, command: LaneCommand) -> None:
        if isinstance(command, AskBulk):
            self.send(BulkKey(key=self._keys.key_of(self)))
        else:
            topics.carry_out(self, command)

    def _late(self) -> bytes:
        return self._backlog.frame(binary_head) if self._backlog else b""
