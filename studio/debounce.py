"""Work that can wait: a Debouncer runs it when it is quiet, a Throttle runs it every so often."""

from __future__ import annotations

import asyncio
from inspect import isawaitable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable


class Debouncer:
    """Runs `work` once nothing has triggered it for `quiet_s`.

    A trigger cancels the run in progress, whose result would be out of date. What `work` starts by
    itself goes on.

    Args:
        work: A plain or an async function without arguments.
        quiet_s: Pause after the last trigger.
        ready: Awaited after a trigger, before the pause begins.
    """

    def __init__(
        self,
        work: Callable[[], Awaitable[None] | None],
        quiet_s: float,
        ready: Callable[[], Awaitable[None]] | None = None,
    ) -> None:
        self._work, self._quiet_s, self._ready = work, quiet_s, ready
        self._task: asyncio.Task[None] | None = None

    def trigger(self) -> None:
        """Start the pause again."""
        self.cancel()
        self._task = asyncio.create_task(self._run())

    def cancel(self) -> None:
        """Forget the last trigger."""
        if self._task is not None:
            self._task.cancel()

    @property
    def is_settled(self) -> bool:
        """Whether the work is done that was triggered."""
        return self._task is None or self._task.done()

    async def settled(self) -> None:
        """Wait until the work is done that was triggered."""
        while self._task is not None and not self._task.done():
            await asyncio.wait({self._task})

    async def close(self) -> None:
        """Cancel, and wait for the work to end."""
        self.cancel()
        if self._task is not None:
            await asyncio.gather(self._task, return_exceptions=True)

    async def _run(self) -> None:
        if self._ready is not None:
            await self._ready()
        await asyncio.sleep(self._quiet_s)
        working = self._work()
        if isawaitable(working):
            await working


class Throttle:
    """Runs `work` soon after a trigger, one run at a time and `pause_s` apart.

    What triggers it during a run is covered by one more run.

    Args:
        work: An async function without arguments.
        first_s: How long the first run after a rest waits.
        pause_s: How long it waits between two runs.
    """

    def __init__(
        self, work: Callable[[], Awaitable[None]], *, first_s: float = 0.0, pause_s: float = 0.0
    ) -> None:
        self._work, self._first_s, self._pause_s = work, first_s, pause_s
        self._triggered = False
        self._task: asyncio.Task[None] | None = None

    def trigger(self) -> None:
        """Run it soon."""
        self._triggered = True
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._run())

    async def close(self) -> None:
        """Cancel the run in progress."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    async def _run(self) -> None:
        await asyncio.sleep(self._first_s)
        while self._triggered:
            self._triggered = False
            await self._work()
            await asyncio.sleep(self._pause_s)
