"""Lookout: looks once something may have changed, soon, and not too often while that goes on."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable


class Lookout:
    """Keeps one look under way at a time; what is doubted meanwhile is looked at after it.

    Args:
        look: One look; it tells what it found by itself.
        first_s: How long the first look after a rest waits, for what gave cause goes out first.
        pause_s: Between two looks.
    """

    def __init__(
        self, look: Callable[[], Awaitable[None]], *, first_s: float = 0.0, pause_s: float = 0.0
    ) -> None:
        self._look, self._first_s, self._pause_s = look, first_s, pause_s
        self._doubted = False
        self._looking: asyncio.Task[None] | None = None

    def doubt(self) -> None:
        """Something may have changed."""
        self._doubted = True
        if self._looking is None or self._looking.done():
            self._looking = asyncio.create_task(self._look_while_doubted())

    async def close(self) -> None:
        """Look no more."""
        if self._looking:
            self._looking.cancel()
            await asyncio.gather(self._looking, return_exceptions=True)

    async def _look_while_doubted(self) -> None:
        await asyncio.sleep(self._first_s)
        while self._doubted:
            self._doubted = False
            await self._look()
            await asyncio.sleep(self._pause_s)
