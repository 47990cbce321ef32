"""HeardTopic: a topic that is heard from the first question on, while there is a connection."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.desk import WireDesk
    from studio.live.connection.link import WireLink

    Hear: TypeAlias = Callable[[WireLink], Callable[[], None]]
    """Begins to hear, in a thread; gives what ends that."""


class HeardTopic:
    """Of the loop; whoever asks for what came calls `listen` before."""

    def __init__(self, wire: WireDesk, hear: Hear) -> None:
        self._wire, self._hear = wire, hear
        self._listening = asyncio.Lock()
        self._link: WireLink | None = None
        self._end: Callable[[], None] | None = None

    @property
    def is_heard(self) -> bool:
        """Something may come."""
        return self._link is not None

    async def listen(self) -> None:
        """Hear it by the connection of now, if there is one."""
        async with self._listening:
            link = self._wire.current
            if link is not None and link is not self._link:
                self._end = await asyncio.to_thread(self._hear, link)
                self._link = link

    async def let_go(self) -> None:
        """Hear nothing more by the connection of now."""
        async with self._listening:
            end, self._end, self._link = self._end, None, None
            if end is not None:
                await asyncio.to_thread(end)
