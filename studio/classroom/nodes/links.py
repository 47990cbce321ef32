"""Links into the students' domains: opened when somebody looks, closed when nobody does."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.link import WireLink

IDLE_S: Final = 30.0
"""So long a link is kept that nobody asks for."""
TOKENS_MAX: Final = 5_000
"""Nodes and endpoints of one domain; a student may declare any number of them."""
CROWDED_S: Final = 60.0
"""So long a domain with more is not looked into."""
_LOOK_EVERY_S: Final = 5.0


@dataclass(slots=True)
class _Held:
    opening: asyncio.Task[WireLink]
    used_s: float

    @property
    def has_failed(self) -> bool:
        done = self.opening.done()
        return done and (self.opening.cancelled() or self.opening.exception() is not None)


class DomainLinks:
    """Holds at most one link for each domain; used on the event loop only.

    Args:
        open_link: Opens the link of a domain, in a thread; what it is given is to be called
            whenever the graph has changed, from any thread.
    """

    def __init__(self, open_link: Callable[[int, Callable[[], None]], WireLink]) -> None:
        self._open = open_link
        self._crowded_s: dict[int, float] = {}
        """Until when a domain is not looked into."""
        self._closing: set[asyncio.Task[None]] = set()
        self._held: dict[int, _Held] = {}
        self._sweeping: asyncio.Task[None] | None = None

    def __len__(self) -> int:
        return len(self._held)

    async def get(self, domain: int) -> WireLink:
        """Return the link of a domain, which is kept for `IDLE_S` from now.

        Raises:
            StudioError: It cannot be opened, or was closed meanwhile.
        """
        loop = asyncio.get_running_loop()
        if loop.time() < self._crowded_s.get(domain, 0.0):
            raise CommandError(
                f"Domain {domain} has more than {TOKENS_MAX} nodes and endpoints: end some of "
                "them, and look again in a minute."
            )
        held = self._held.get(domain)
        if held is None or held.has_failed:
            opening = asyncio.create_task(self._opened(domain))
            held = self._held[domain] = _Held(opening, loop.time())
        if self._sweeping is None or self._sweeping.done():
            self._sweeping = asyncio.create_task(self._sweep())
        try:
            link = await asyncio.shield(held.opening)
        except BaseException:
            if held.has_failed and self._held.get(domain) is held:
                del self._held[domain]
            raise
        if self._held.get(domain) is not held:
            raise CommandError("Access for nodes was switched off meanwhile: ask again.")
        held.used_s = loop.time()
        return link

    async def _opened(self, domain: int) -> WireLink:
        loop = asyncio.get_running_loop()
        link: WireLink | None = None

        def changed() -> None:
            if link is not None and link.graph.token_count > TOKENS_MAX and not loop.is_closed():
                loop.call_soon_threadsafe(self._leave, domain)

        link = await asyncio.to_thread(self._open, domain, changed)
        changed()
        return link

    def _leave(self, domain: int) -> None:
        """Look no longer into a domain that is crowded."""
        if domain in self._held:
            self._crowded_s[domain] = asyncio.get_running_loop().time() + CROWDED_S
            closing = asyncio.create_task(self.close_one(domain))
            self._closing.add(closing)
            closing.add_done_callback(self._closing.discard)

    async def close_one(self, domain: int) -> None:
        """End the link of a domain, if there is one."""
        if held := self._held.pop(domain, None):
            await asyncio.wait((held.opening,))
            if not held.has_failed:
                await asyncio.to_thread(held.opening.result().close)

    async def close(self) -> None:
        """End all links; others may be opened afterwards."""
        if self._sweeping is not None:
            self._sweeping.cancel()
            await asyncio.gather(self._sweeping, return_exceptions=True)
            self._sweeping = None
        await asyncio.gather(*map(self.close_one, tuple(self._held)), *self._closing)

    async def _sweep(self) -> None:
        loop = asyncio.get_running_loop()
        while self._held:
            await asyncio.sleep(min(_LOOK_EVERY_S, IDLE_S))
            over_s = loop.time() - IDLE_S
            for domain, held in tuple(self._held.items()):
                if held.opening.done() and held.used_s < over_s:
                    await self.close_one(domain)
