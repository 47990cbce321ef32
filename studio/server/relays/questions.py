"""Questions of a relay to the origin that have one answer each, by the number that it repeats."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final, Generic, Protocol, TypeVar

from studio.errors import OriginAwayError

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.server.relays.messages import Up

_ANSWER_S: Final = 30.0


class Numbered(Protocol):
    """An answer."""

    @property
    def number(self) -> int:
        """Of the question."""
        ...


AnswerT = TypeVar("AnswerT", bound=Numbered)


class Questions(Generic[AnswerT]):
    """Used on the event loop only.

    Args:
        send: To the origin.
        most: So many are asked at once.
    """

    def __init__(self, send: Callable[[Up], object], most: int) -> None:
        self._send, self._most = send, most
        self._waiting: dict[int, asyncio.Future[AnswerT]] = {}

    @property
    def is_full(self) -> bool:
        """Whether as many are asked as may be."""
        return len(self._waiting) >= self._most

    async def ask(self, number: int, message: Up) -> AnswerT:
        """Return the answer.

        Raises:
            OriginAwayError: None came in time, or the origin went.
        """
        future: asyncio.Future[AnswerT] = asyncio.get_running_loop().create_future()
        self._waiting[number] = future
        self._send(message)
        try:
            return await asyncio.wait_for(future, _ANSWER_S)
        except TimeoutError:
            raise OriginAwayError from None
        finally:
            self._waiting.pop(number, None)

    def answer(self, message: AnswerT) -> None:
        """Take an answer; nothing happens if nobody waits for it."""
        future = self._waiting.get(message.number)
        if future is not None and not future.done():
            future.set_result(message)

    def give_up(self) -> None:
        """The origin went: who waits is told."""
        for future in self._waiting.values():
            if not future.done():
                future.set_exception(OriginAwayError())
