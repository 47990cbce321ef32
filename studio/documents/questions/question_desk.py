"""Answers questions one at a time, in the gaps that edits leave."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from studio.documents.questions.question_queue import QuestionQueue

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.description.requests import Query, Reply
    from studio.protocol.listeners import Listener

REST_S: Final = 0.3
"""Quiet time after which a drag, or a round of typing, counts as at rest."""


class QuestionDesk:
    """No question is begun while a run is under way or waits: an edit overtakes all but one.

    Args:
        runs_end: Waits until no run is under way; does not wait when none is.
        reply: Gives the answer to one question.
    """

    def __init__(
        self,
        runs_end: Callable[[], Awaitable[None]],
        reply: Callable[[Query], Awaitable[Reply]],
    ) -> None:
        self._runs_end, self._reply = runs_end, reply
        self._queue = QuestionQueue()
        self._answering: asyncio.Task[None] | None = None
        self._rest: asyncio.TimerHandle | None = None
        """Counts the quiet time while long questions are held."""
        self._is_held = False

    async def ask(self, query: Query, asker: Listener) -> Reply:
        """Wait for the turn of a question, and for its answer.

        Raises:
            SupersededError: The asker has newer questions of that kind.
        """
        answer = self._queue.add(query, asker)
        self._go_on()
        return await answer

    def hold(self) -> None:
        """Somebody drags or types, and a run comes of it: what takes long waits until they rest."""
        self._is_held = True
        self._keep_waiting()

    def run_ended(self) -> None:
        """Count the quiet time from now on."""
        if self._is_held:
            self._keep_waiting()
            self._rest = asyncio.get_running_loop().call_later(REST_S, self._release)

    async def close(self) -> None:
        """Answer nothing any more; whoever waits is cancelled."""
        self._keep_waiting()
        self._queue.cancel()
        if self._answering is not None:
            self._answering.cancel()
            await asyncio.gather(self._answering, return_exceptions=True)

    def _keep_waiting(self) -> None:
        if self._rest is not None:
            self._rest.cancel()
            self._rest = None

    def _release(self) -> None:
        self._is_held = False
        self._go_on()

    def _go_on(self) -> None:
        if self._answering is None or self._answering.done():
            self._answering = asyncio.create_task(self._answer_all())

    async def _answer_all(self) -> None:
        while True:
            await self._runs_end()
            taken = self._queue.take(is_held=self._is_held)
            if taken is None:
                return
            try:
                taken.settle(await self._reply(taken.query))
            except asyncio.CancelledError:
                taken.cancel()
                raise
            except Exception as error:  # noqa: BLE001 - handed on to everyone who asked
                taken.fail(error)
