"""Nearby: counts the nodes at this machine's router while the studio is not connected."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.errors import StudioError
from studio.live.connection.plan import planned_wire
from studio.ros.wire.endpoints import ProbeResult, parse_endpoint, probe

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.settings import WireChoice

_PAUSE_S: Final = 5.0
"""Between two checks."""


class Nearby:
    """Checks repeatedly while `is_wanted`, and calls `changed` when the number changed.

    Only the router of this machine is checked, since nobody asked to reach another. Where none
    answers, a check costs one TCP connection, and Zenoh is not imported.
    """

    def __init__(
        self,
        choice: Callable[[], WireChoice],
        is_wanted: Callable[[], bool],
        changed: Callable[[], None],
    ) -> None:
        self._choice, self._is_wanted, self._changed = choice, is_wanted, changed
        self._task: asyncio.Task[None] | None = None
        self.node_count = 0
        """In the domain that would be joined; 0 while nothing is checked."""

    def check(self) -> None:
        """Start to check, if that is wanted and not running."""
        if self._is_wanted() and (self._task is None or self._task.done()):
            self._task = asyncio.create_task(self._check())

    async def close(self) -> None:
        """Stop checking."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    async def _check(self) -> None:
        while self._is_wanted():
            self._take(await asyncio.to_thread(nodes_nearby, self._choice()))
            await asyncio.sleep(_PAUSE_S)
        self.node_count = 0

    def _take(self, count: int) -> None:
        if count != self.node_count and self._is_wanted():
            self.node_count = count
            self._changed()


def nodes_nearby(choice: WireChoice) -> int:
    """Count the nodes at this machine's router; 0 if it does not answer or is not wanted.

    Takes some seconds at most: call it in a thread.
    """
    try:
        places = [parse_endpoint(one) for one in planned_wire(choice).connect]
        is_here = len(places) == 1 and places[0].is_loopback and places[0].is_stream
        if not is_here or probe(places[0]) is not ProbeResult.ZENOH:
            return 0
        from studio.live.connection.report import examine  # noqa: PLC0415 - imports zenoh

        return examine(choice, ()).nodes
    except StudioError:
        return 0
