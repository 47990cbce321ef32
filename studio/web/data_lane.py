"""The data lane: a browser says what it hears, as JSON text; what comes goes to it in ticks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from pydantic import ValidationError

from studio.engine.bridge.hearing_backlog import Backlog
from studio.engine.messages.hearing import WISHES, NotHeard
from studio.hub import Outlet
from studio.web.commands import malformed
from studio.web.lane import FrameTransport, binary_frame, text_frame

if TYPE_CHECKING:
    from pydantic import BaseModel

    from studio.engine.bridge.hearing_frames import Tick
    from studio.web.lane import Lane
    from studio.web.surface import HearsTopics

_TOO_SLOW: Final = 1013
"""Close code `try again later`: the page connects anew and wishes all again."""
_WISH_LIMIT_BYTES: Final = 4_096
_TICK: Final = "tick"


class DataLane:
    """One browser's data lane: the Hearer to which the engine hands what came."""

    def __init__(self, lane: Lane) -> None:
        self._lane = lane
        self._backlog = Backlog()
        self._outlet = Outlet(FrameTransport(lane), on_hopeless=lambda: lane.close(_TOO_SLOW))
        lane.on_drain(self._outlet.resume)

    def say(self, message: BaseModel, /) -> None:
        """Queue one message in words."""
        self._outlet.post(text_frame(message.model_dump_json().encode()))

    def take(self, tick: Tick, /) -> None:
        """Send what came; what cannot go now is kept as far as it is of worth."""
        if not self._outlet.holds_back and not self._backlog.dropped:
            if self._outlet.post(binary_frame(tick.frame), _TICK, late=self._late):
                return
            self._backlog.add(tick.chunks)
        else:
            self._backlog.add(tick.chunks)
            self._outlet.post(self._late, _TICK)

    async def serve(self, hearing: HearsTopics) -> None:
        """Carry out wishes until the browser leaves."""
        hearing.attach(self)
        try:
            while (text := await self._lane.receive()) is not None:
                self._wish(hearing, text)
        finally:
            hearing.detach(self)
            self._outlet.close()
            await self._lane.finish()

    def _wish(self, hearing: HearsTopics, text: bytes) -> None:
        if len(text) > _WISH_LIMIT_BYTES:
            self.say(NotHeard(wish=0, reason="A wish of so many bytes is not read."))
            return
        try:
            wish = WISHES.validate_json(text)
        except ValidationError as error:
            self.say(NotHeard(wish=0, reason=malformed("wish", error)))
        else:
            hearing.wish(self, wish)

    def _late(self) -> bytes:
        return binary_frame(self._backlog.frame()) if self._backlog else b""
