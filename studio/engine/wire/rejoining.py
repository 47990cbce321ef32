"""Rejoining: which connection a document draws from, and joining it again by itself."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING

from studio.engine.wire.plan import planned_wire
from studio.errors import StudioError
from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.probing import Answer, probe

if TYPE_CHECKING:
    from studio.engine.wire.desk import WireDesk
    from studio.engine.wire.link import WireLink
    from studio.settings import WireChoice

_log = logging.getLogger(__name__)


class Rejoining:
    """Follows whether there is a connection; `place` says where it is, to be kept.

    A document that was connected when it was open last is connected again, if the studio would
    look at the same place and a router answers there: none is started, and nobody else is asked.
    """

    def __init__(self, wire: WireDesk) -> None:
        self._wire = wire
        self._link: WireLink | None = None
        self.place = ""
        """Empty: not connected when somebody last disconnected, or never."""

    def has_moved(self) -> bool:
        """Whether there is another connection, or none any more, since this was asked last."""
        link, before = self._wire.current, self._link
        if link is before:
            return False
        self._link, self.place = link, place_of(self._wire.choice) if link else ""
        return True

    async def rejoin(self, place: str) -> None:
        """Connect as before; nothing, if that is not possible."""
        self.place = place  # until somebody disconnects, a router that is away is waited for
        if not place or place != place_of(self._wire.choice):
            return
        try:
            if await asyncio.to_thread(_answers, self._wire.choice):
                await self._wire.link()
        except StudioError as error:
            _log.info("Not connected again: %s", error)


def place_of(choice: WireChoice) -> str:
    """Where a connection is looked for, as one word; empty where the settings are wrong."""
    try:
        planned = planned_wire(choice)
    except StudioError:
        return ""
    return f"{', '.join(planned.connect)} domain {planned.domain}"


def _answers(choice: WireChoice) -> bool:
    """Whether a router is there already; waits for a while where nothing answers."""
    places = [parse_endpoint(one) for one in planned_wire(choice).connect]
    return any(probe(one) in {Answer.ZENOH, Answer.TLS} for one in places)
