"""Commands that a relay passed on: each is asked of one run of the studio, until it is answered."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, OriginAwayError
from studio.protocol.edits import Undo
from studio.server.relays.passed_on import PassedOn
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.server.relays.messages import Ask


class Line:
    """What was put on it, while it is there."""

    def __init__(self) -> None:
        self.is_there = True
        self.put: list[Ask] = []
        self.passed_on = PassedOn(self._put)
        self.ear = Ear()

    def _put(self, ask: Ask) -> bool:
        if self.is_there:
            self.put.append(ask)
        return self.is_there

    async def ask(self, number: int, name: str = "") -> asyncio.Task[None]:
        """Pass a command on; it waits."""
        command = Undo(document="rover", request=number, id=name)
        asked = asyncio.create_task(self.passed_on.ask(number, 1, command, self.ear))
        await asyncio.sleep(0)
        return asked

    def again(self) -> list[int]:
        """What is asked on a new line."""
        self.is_there, self.put = True, []
        self.passed_on.ask_again(lambda _: None)
        return [one.number for one in self.put]

    @property
    def refused(self) -> list[int]:
        """The numbers of requests that the relay refused by itself."""
        return [event["request"] for event in self.ear.events if event["type"] == "refused"]


def run(work: Callable[[Line], Awaitable[None]]) -> None:
    async def begin() -> None:
        await work(Line())

    asyncio.run(begin())


def test_what_was_not_answered_is_asked_again_on_a_new_line_by_the_same_id():
    async def work(line: Line) -> None:
        first, second = await line.ask(1), await line.ask(2)
        before = line.put[1].text
        line.passed_on.settle(1)
        await first
        assert line.again() == [2]
        assert line.put[0].text == before
        line.passed_on.settle(2)
        await second
        assert line.again() == []

    run(work)


def test_of_a_studio_that_was_started_anew_only_what_no_other_was_sent_is_asked():
    async def work(line: Line) -> None:
        sent = await line.ask(1)
        line.is_there = False
        waits = await line.ask(2)
        line.passed_on.refuse_sent()
        assert line.again() == [2]
        await sent
        assert line.refused == [1]
        assert not waits.done()
        line.passed_on.refuse_sent()
        await waits
        assert line.refused == [1, 2]

    run(work)


def test_who_left_waits_no_more():
    async def work(line: Line) -> None:
        asked = await line.ask(1)
        line.passed_on.leave(1)
        await asked
        assert line.again() == []
        assert line.refused == []

    run(work)


def test_all_are_told_when_the_studio_stays_away():
    async def work(line: Line) -> None:
        asked = [await line.ask(number) for number in (1, 2)]
        line.passed_on.refuse_all(OriginAwayError())
        await asyncio.gather(*asked)
        assert line.refused == [1, 2]

    run(work)


def test_so_much_waits_and_no_more():
    async def work(line: Line) -> None:
        asked = [await line.ask(number) for number in range(10_000)]
        with pytest.raises(CommandError):
            await line.passed_on.ask(10_000, 1, Undo(), line.ear)
        line.passed_on.leave(1)
        await asyncio.gather(*asked)

    run(work)
