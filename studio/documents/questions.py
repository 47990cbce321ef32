"""Questions to the worker of a document: queued, few of each asker, answered between two runs."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final
from weakref import WeakSet

from studio.description.language.questions import CompletionQuery, LookUpQuery
from studio.description.origins.origin_values import PartOriginQuery
from studio.errors import SupersededError
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterator

    from studio.description.requests import Query, Reply
    from studio.protocol.listeners import Listener


KEPT: Final = 4
"""Limit for one asker and one kind in `_TOGETHER`."""
_TOGETHER: Final = frozenset({PartOriginQuery, LookUpQuery})
"""Kinds that a page asks together: a link, its joint and the part that a panel explains; the text
under the pointer and the one whose definition is wanted. Of all others only the newest counts."""
WAITING_LIMIT: Final = 64
"""Limit of waiting questions of viewers: a client that is no browser may ask without end."""


class Waiting:
    """One question and all who asked it."""

    def __init__(self, query: Query) -> None:
        self.query = query
        self._answers: dict[asyncio.Future[Reply], Listener] = {}

    def join(self, asker: Listener) -> asyncio.Future[Reply]:
        """Add an asker; the future gets the answer."""
        answer: asyncio.Future[Reply] = asyncio.get_running_loop().create_future()
        self._answers = {one: by for one, by in self._answers.items() if not one.done()}
        self._answers[answer] = asker
        return answer

    @property
    def askers(self) -> set[Listener]:
        """Those who wait for the answer."""
        return {asker for answer, asker in self._answers.items() if not answer.done()}

    def supersede(self, asker: Listener) -> None:
        """End the wait of an asker who has newer questions."""
        for answer, one in self._answers.items():
            if one is asker and not answer.done():
                answer.set_exception(SupersededError())

    def settle(self, reply: Reply) -> None:
        """Answer all who still wait."""
        for answer in self._open():
            answer.set_result(reply)

    def fail(self, error: Exception) -> None:
        """Hand an error on to all who still wait."""
        for answer in self._open():
            answer.set_exception(error)

    def cancel(self) -> None:
        """Cancel it for all askers."""
        for answer in self._open():
            answer.cancel()

    def _open(self) -> Iterator[asyncio.Future[Reply]]:
        return (answer for answer in self._answers if not answer.done())


class QuestionQueue:
    """The questions of one document, the oldest first; equal ones of several askers are one.

    Of one asker and kind only the newest are kept, for a page asks again with each selection;
    earlier ones end in a SupersededError.
    """

    def __init__(self) -> None:
        self._waiting: list[Waiting] = []
        self._served: WeakSet[Listener] = WeakSet()
        """Askers of the last answer: the next one goes to another viewer, if one waits."""

    def __len__(self) -> int:
        """Return the number of waiting questions."""
        return len(self._waiting)

    def add(self, query: Query, asker: Listener) -> asyncio.Future[Reply]:
        """Add a question; the future gets its reply."""
        self._forget_those_left()
        waiting = next((one for one in self._waiting if one.query == query), None)
        if waiting is None:
            waiting = Waiting(query)
            self._waiting.append(waiting)
        answer = waiting.join(asker)
        self._keep_newest(waiting, asker)
        self._keep_within_limit()
        return answer

    def take(self, *, is_held: bool) -> Waiting | None:
        """Return the one to answer next; while held, only what is asked in the midst of typing."""
        self._forget_those_left()
        ready = [one for one in self._waiting if not (is_held and _is_long(one.query))]
        if not ready:
            return None
        taken = min(ready, key=lambda one: (_is_viewers(one), self._served.issuperset(one.askers)))
        self._waiting.remove(taken)
        self._served = WeakSet(taken.askers)
        return taken

    def cancel(self) -> None:
        """Cancel all questions."""
        waiting, self._waiting = self._waiting, []
        for one in waiting:
            one.cancel()

    def _keep_newest(self, newest: Waiting, asker: Listener) -> None:
        kind = type(newest.query)
        others = [
            one
            for one in self._waiting
            if one is not newest and type(one.query) is kind and asker in one.askers
        ]
        beside = KEPT - 1 if kind in _TOGETHER else 0
        for one in others[: max(0, len(others) - beside)]:
            one.supersede(asker)

    def _keep_within_limit(self) -> None:
        self._forget_those_left()
        of_viewers = [one for one in self._waiting if _is_viewers(one)]
        for one in of_viewers[:-WAITING_LIMIT]:
            one.fail(SupersededError())
            self._waiting.remove(one)

    def _forget_those_left(self) -> None:
        self._waiting = [one for one in self._waiting if one.askers]


def _is_long(query: Query) -> bool:
    """Whether an answer may need the whole robot once more, traced."""
    return not isinstance(query, CompletionQuery)


def _is_viewers(waiting: Waiting) -> bool:
    return all(asker.role is not Role.PRESENTER for asker in waiting.askers)


REST_S: Final = 0.3
"""Quiet time after which a drag, or a round of typing, counts as at rest."""


class Questions:
    """Answers questions between runs: an edit overtakes all but the one being answered.

    Slow ones also wait until a drag or typing has ended.

    Args:
        runs_end: Waits while there is a run; returns at once without one.
        gesture_ended_s: When the last run of a drag, or of typing, ended, by the loop's clock.
        reply: Returns the answer to one question.
    """

    def __init__(
        self,
        runs_end: Callable[[], Awaitable[None]],
        gesture_ended_s: Callable[[], float],
        reply: Callable[[Query], Awaitable[Reply]],
    ) -> None:
        self._runs_end, self._gesture_ended_s, self._reply = runs_end, gesture_ended_s, reply
        self._queue = QuestionQueue()
        self._answering: asyncio.Task[None] | None = None
        self._rest: asyncio.TimerHandle | None = None
        """Answers slow questions when the pause after a gesture is over."""

    async def ask(self, query: Query, asker: Listener) -> Reply:
        """Wait for the turn of a question, and for its answer.

        Raises:
            SupersededError: The asker has newer questions of that kind.
        """
        answer = self._queue.add(query, asker)
        self._go_on()
        return await answer

    async def close(self) -> None:
        """Answer nothing any more; those waiting are cancelled."""
        self._end_rest()
        self._queue.cancel()
        if self._answering is not None:
            self._answering.cancel()
            await asyncio.gather(self._answering, return_exceptions=True)

    def _go_on(self) -> None:
        if self._answering is None or self._answering.done():
            self._answering = asyncio.create_task(self._answer_all())

    async def _answer_all(self) -> None:
        while True:
            await self._runs_end()
            loop = asyncio.get_running_loop()
            rests_at_s = self._gesture_ended_s() + REST_S
            is_held = loop.time() < rests_at_s
            taken = self._queue.take(is_held=is_held)
            if taken is None:
                self._end_rest()
                if is_held and len(self._queue):
                    self._rest = loop.call_at(rests_at_s, self._go_on)
                return
            try:
                taken.settle(await self._reply(taken.query))
            except asyncio.CancelledError:
                taken.cancel()
                raise
            except Exception as error:  # noqa: BLE001 - handed on to everyone who asked
                taken.fail(error)

    def _end_rest(self) -> None:
        if self._rest is not None:
            self._rest.cancel()
            self._rest = None
