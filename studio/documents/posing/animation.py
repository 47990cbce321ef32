"""The tick: swings the joints of a document at up to 60 Hz while somebody asked for it."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

TICK_S = 1 / 60


class Animation:
    """Calls `step(time_s)` once per tick between `start` and `stop`; late ticks are skipped."""

    def __init__(self, step: Callable[[float], None]) -> None:
        self._step = step
        self._task: asyncio.Task[None] | None = None

    @property
    def running(self) -> bool:
        """Whether the joints swing now."""
        return self._task is not None and not self._task.done()

    def start(self) -> None:
        """Begin, unless it runs."""
        if not self.running:
            self._task = asyncio.create_task(self._run())

    def stop(self) -> None:
        """End where the joints are."""
        if self._task:
            self._task.cancel()
        self._task = None

    async def _run(self) -> None:
        loop = asyncio.get_running_loop()
        began_s = next_s = loop.time()
        while True:
            self._step(loop.time() - began_s)
            next_s = max(next_s + TICK_S, loop.time())
            await asyncio.sleep(next_s - loop.time())
