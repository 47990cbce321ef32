"""A command that is sent again after its connection broke runs once."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError
from studio.protocol.commands import REMEMBERED_MAX, REMEMBERED_OF_ONE, AtMostOnce
from studio.protocol.documents import Places
from studio.protocol.edits import Undo
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from studio.protocol.commands import Answer
    from studio.protocol.listeners import Listener
    from studio.protocol.message import Command


class Work:
    """Counts how often it ran; waits until `go_on`, and fails at a command for `broken`."""

    def __init__(self) -> None:
        self.runs, self.go_on = 0, asyncio.Event()

    async def carry_out(self, command: Command, _: Listener) -> Answer:
        self.runs += 1
        await self.go_on.wait()
        if command.document == "broken":
            raise CommandError("It is broken.")
        return Places(request=command.request, folders=(str(self.runs),))


def test_without_an_id_every_command_runs():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        work.go_on.set()
        for _ in range(3):
            await once.run(Undo(), Ear(), work.carry_out)
        assert work.runs == 3

    asyncio.run(run())


def test_what_is_sent_again_while_it_runs_or_later_gets_the_first_answer_with_its_own_number():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        first = asyncio.create_task(once.run(Undo(id="x", request=1), Ear(), work.carry_out))
        again = asyncio.create_task(once.run(Undo(id="x", request=2), Ear(), work.carry_out))
        await asyncio.sleep(0)
        work.go_on.set()
        answers = [await first, await again]
        answers.append(await once.run(Undo(id="x", request=3), Ear(), work.carry_out))
        assert answers == [Places(request=number, folders=("1",)) for number in (1, 2, 3)]
        assert work.runs == 1

    asyncio.run(run())


def test_a_refusal_is_repeated_and_not_tried_again():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        work.go_on.set()
        for _ in range(2):
            with pytest.raises(CommandError, match="It is broken"):
                await once.run(Undo(id="x", document="broken"), Ear(), work.carry_out)
        assert work.runs == 1

    asyncio.run(run())


def test_who_leaves_does_not_stop_what_runs():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        first = asyncio.create_task(once.run(Undo(id="x"), Ear(), work.carry_out))
        await asyncio.sleep(0)
        first.cancel()
        await asyncio.gather(first, return_exceptions=True)
        work.go_on.set()
        assert await once.run(Undo(id="x"), Ear(), work.carry_out) is not None
        assert work.runs == 1

    asyncio.run(run())


def test_the_same_id_of_another_person_is_another_command():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        work.go_on.set()
        one, other = Ear(), Ear()
        other.person = "other"
        for who in (one, other):
            await once.run(Undo(id="x"), who, work.carry_out)
        assert work.runs == 2

    asyncio.run(run())


def test_only_so_many_outcomes_of_a_person_are_kept():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        work.go_on.set()
        for number in range(REMEMBERED_OF_ONE + 1):
            await once.run(Undo(id=str(number)), Ear(), work.carry_out)
        await once.run(Undo(id=str(REMEMBERED_OF_ONE)), Ear(), work.carry_out)
        assert work.runs == REMEMBERED_OF_ONE + 1
        await once.run(Undo(id="0"), Ear(), work.carry_out)
        assert work.runs == REMEMBERED_OF_ONE + 2

    asyncio.run(run())


def test_however_much_others_ask_what_a_person_asked_last_is_remembered():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        work.go_on.set()
        first, second = Ear(), Ear()
        first.person, second.person = "first", "second"
        await once.run(Undo(id="a"), first, work.carry_out)
        for number in range(2_000):
            await once.run(Undo(id=str(number)), second, work.carry_out)
        await once.run(Undo(id="a"), first, work.carry_out)
        assert work.runs == 2_001

    asyncio.run(run())


def test_of_very_many_persons_who_asked_nothing_for_longest_is_forgotten():
    async def run() -> None:
        once, work = AtMostOnce(), Work()
        work.go_on.set()
        ear = Ear()
        for number in range(REMEMBERED_MAX + 1):
            ear.person = str(number)
            await once.run(Undo(id="a"), ear, work.carry_out)
        await once.run(Undo(id="a"), ear, work.carry_out)
        assert work.runs == REMEMBERED_MAX + 1
        ear.person = "0"
        await once.run(Undo(id="a"), ear, work.carry_out)
        assert work.runs == REMEMBERED_MAX + 2

    asyncio.run(run())
