"""AtMostOnce: a command that carries an id runs once, however often it is sent."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.protocol.commands import Answer
    from studio.protocol.listeners import Listener
    from studio.protocol.message import Command

REMEMBERED_MAX: Final = 1_000
"""Outcomes, of all persons together; the oldest are forgotten first."""


class AtMostOnce:
    """Remembers how commands with an id ended, by person and id.

    A page sends what was not answered before its connection broke once more. If it ran, or runs
    still, the answer is that of the first time, errors too.
    """

    def __init__(self) -> None:
        self._outcomes: OrderedDict[tuple[str, str], asyncio.Task[Answer]] = OrderedDict()

    async def run(
        self,
        command: Command,
        asker: Listener,
        carry_out: Callable[[Command, Listener], Awaitable[Answer]],
    ) -> Answer:
        """Carry the command out, unless that was done, or is under way.

        Raises:
            StudioError: As `carry_out` does, or did.
        """
        if not command.id:
            return await carry_out(command, asker)
        key = asker.person, command.id
        if key not in self._outcomes:
            self._outcomes[key] = asyncio.ensure_future(carry_out(command, asker))
            while len(self._outcomes) > REMEMBERED_MAX:
                self._outcomes.popitem(last=False)
        # Who asked may leave: what runs is finished all the same.
        answer = await asyncio.shield(self._outcomes[key])
        if answer is not None and "request" in type(answer).model_fields:
            return answer.model_copy(update={"request": command.request})
        return answer
