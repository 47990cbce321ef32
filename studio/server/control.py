"""The control lane: commands in, events out, as JSON text; joint streams out as binary frames."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.hub import Outlet
from studio.server.commands import answer
from studio.server.lane import FrameTransport, binary_frame, text_frame

if TYPE_CHECKING:
    from studio.protocol.documents import Hello
    from studio.protocol.roles import Visitor
    from studio.server.lane import Lane
    from studio.server.surface import OpenDocuments

_UNDER_WAY_LIMIT: Final = 64
"""Commands of one browser that may wait for the engine; then its socket is not read."""
_TOO_SLOW: Final = 1013
"""Close code `try again later`: the page connects anew and gets the whole state."""


class ControlLane:
    """One browser's control lane: the Listener that the engine posts to."""

    def __init__(self, lane: Lane, visitor: Visitor) -> None:
        self.role, self.person = visitor.role, visitor.person
        self._lane = lane
        self._outlet = Outlet(FrameTransport(lane), on_hopeless=lambda: lane.close(_TOO_SLOW))
        lane.on_drain(self._outlet.resume)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        """Queue one message without waiting; of one `key` only the newest need arrive."""
        self._outlet.post(binary_frame(data) if binary else text_frame(data), key)

    async def serve(self, engine: OpenDocuments, hello: Hello) -> None:
        """Greet, then answer commands until the browser leaves.

        Commands start in their order but do not wait for each other: a slow one stops no slider.
        What is under way when the browser leaves is finished; a save is not given up half-way.
        """
        self.post(hello.model_dump_json().encode())
        engine.attach(self)
        try:
            async with asyncio.TaskGroup() as group:
                under_way = await self._answer_all(engine, group)
                if self._lane.server_ends:  # the engine has ended before: nothing can come of it
                    for task in under_way:
                        task.cancel()
        finally:
            engine.detach(self)
            self._outlet.close()
            await self._lane.finish()

    async def _answer_all(
        self, engine: OpenDocuments, group: asyncio.TaskGroup
    ) -> set[asyncio.Task[None]]:
        """Start every command that comes; gives those that are not done when the lane ends."""
        under_way: set[asyncio.Task[None]] = set()
        while (text := await self._lane.receive()) is not None:
            task = group.create_task(answer(engine, self, text))
            under_way.add(task)
            task.add_done_callback(under_way.discard)
            while len(under_way) >= _UNDER_WAY_LIMIT:
                await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
        return under_way
