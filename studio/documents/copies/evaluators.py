"""A few evaluators that all copies share: who has one may lose it to who waits longest."""

from __future__ import annotations

import asyncio
from collections import OrderedDict, deque
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Final

from studio.description.client import DescriptionWorker
from studio.errors import WorkerDiedError

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from studio.description.requests import Query, Reply
    from studio.description.session import Answer, Request
    from studio.description.values import OpenRequest

EVALUATORS_MAX: Final = 8
"""With `SHARED_MEMORY_BYTES` of each, 2 GiB in all."""


class Evaluators:
    """Lets so many workers have a process at a time; used on the event loop only.

    A worker keeps its process, and with it its robot, until another one waits. Those that wait get
    their turns in the order in which they asked; one that gives its process up gets its robot again
    with its next turn.
    """

    def __init__(self, limit: int = EVALUATORS_MAX) -> None:
        self._limit = limit
        self._holders: OrderedDict[SharedWorker, int] = OrderedDict()
        """Those with a process, the least recently used first, and how many requests run."""
        self._waiting: deque[asyncio.Future[None]] = deque()
        self._entering = 0
        """Those that were let in and have not begun: room is kept for them."""

    def worker(self) -> SharedWorker:
        """Return a worker that takes its turns here."""
        return SharedWorker(self)

    @asynccontextmanager
    async def turn(self, worker: SharedWorker) -> AsyncGenerator[None]:
        """Have a process within this block."""
        await self._enter(worker)
        try:
            yield
        finally:
            if worker in self._holders:
                self._holders[worker] -= 1
            self._admit()

    def forget(self, worker: SharedWorker) -> None:
        """Its process has ended for good."""
        self._holders.pop(worker, None)
        self._admit()

    async def _enter(self, worker: SharedWorker) -> None:
        is_at_work = self._holders.get(worker, 0) > 0
        if self._waiting or not (is_at_work or self._room() > 0):
            await self._wait()
        else:
            self._entering += 1
        try:
            if worker not in self._holders:
                await self._make_room()
            self._holders[worker] = self._holders.get(worker, 0) + 1
            self._holders.move_to_end(worker)
        except BaseException:
            self._entering -= 1
            self._admit()
            raise
        self._entering -= 1

    async def _wait(self) -> None:
        place: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiting.append(place)
        self._admit()
        try:
            await place
        except asyncio.CancelledError:
            if place.cancelled():
                self._waiting.remove(place)
            else:
                self._entering -= 1
            self._admit()
            raise

    def _room(self) -> int:
        """Return how many more may come: processes that nobody has, or that are idle."""
        idle = sum(count == 0 for count in self._holders.values())
        return self._limit - len(self._holders) + idle - self._entering

    def _admit(self) -> None:
        """Wake those that have waited longest, as far as there is room."""
        while self._waiting and self._room() > 0:
            self._entering += 1
            self._waiting.popleft().set_result(None)

    async def _make_room(self) -> None:
        while len(self._holders) >= self._limit:
            idle = next(one for one, count in self._holders.items() if count == 0)
            del self._holders[idle]
            await idle.rest()


class SharedWorker(DescriptionWorker):
    """A worker whose process is there only while it has a turn or nobody else waits."""

    def __init__(self, evaluators: Evaluators) -> None:
        super().__init__(is_shared=True)
        self._evaluators = evaluators

    async def warm(self) -> None:
        """Start nothing: its process comes with its first turn."""

    async def open(self, request: OpenRequest) -> Answer:
        """Start on a file; everything is in the answer."""
        async with self._evaluators.turn(self):
            return await super().open(request)

    async def rest(self) -> None:
        """End the process; the next turn, for which some may wait, opens the robot again."""
        self.needs_reopen = True
        await self._worker.close()

    async def close(self) -> None:
        """End the process for good."""
        await super().close()
        self._evaluators.forget(self)

    async def _ask(self, request: Request) -> Answer:
        async with self._evaluators.turn(self):
            return await super()._ask(request)

    async def _question(self, query: Query) -> Reply:
        async with self._evaluators.turn(self):
            if self.needs_reopen:
                raise WorkerDiedError("xacro", None)  # the asker opens it, and asks again
            return await super()._question(query)
