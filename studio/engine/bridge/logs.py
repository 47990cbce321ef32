"""LogDesk: hears `/rosout` from the first time that somebody looks, as long as it is connected."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from studio.engine.bridge.log_ring import LogRing
from studio.engine.messages.logs import GetLog, LogAnswer

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.engine.wire.desk import WireDesk
    from studio.engine.wire.link import WireLink


class LogDesk:
    """Keeps what was said for whoever comes later, also after the connection has ended."""

    def __init__(self, wire: WireDesk) -> None:
        self._wire = wire
        self._ring = LogRing()
        self._listening = asyncio.Lock()
        self._link: WireLink | None = None
        self._end: Callable[[], None] | None = None

    async def log(self, command: GetLog) -> LogAnswer:
        """Tell what was said after a line; nothing new comes while there is no connection."""
        await self._listen()
        lines, first, last = self._ring.after(command.after)
        return LogAnswer(
            request=command.request,
            connected=self._link is not None,
            lines=lines,
            first=first,
            last=last,
        )

    async def let_go(self) -> None:
        """Hear nothing more by the connection of now."""
        async with self._listening:
            end, self._end, self._link = self._end, None, None
            if end is not None:
                await asyncio.to_thread(end)

    async def _listen(self) -> None:
        async with self._listening:
            link = self._wire.current
            if link is not None and link is not self._link:
                self._end = await asyncio.to_thread(_heard, link, self._ring)
                self._link = link


def _heard(link: WireLink, ring: LogRing) -> Callable[[], None]:
    """Hear it as it is sent: nodes keep what they said for those who come late."""
    from studio.ros.node.rosout import ROSOUT  # noqa: PLC0415 - imports zenoh
    from studio.ros.qos import qos_profile_rosout_default  # noqa: PLC0415

    return link.subscribe("rcl_interfaces/msg/Log", ROSOUT, ring.take, qos_profile_rosout_default)
