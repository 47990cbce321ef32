from __future__ import annotations

import asyncio
from dataclasses import dataclass

import pytest

from studio.errors import CommandError
from studio.live.panels.operations import Operations
from studio.protocol.calls import Calls
from tests.support.open_documents import Ear, until


@dataclass
class Operation:
    operation: int
    is_over: bool = False


def ledger(told: list[tuple[bool, list[int]]]) -> Operations[Operation]:
    def say(is_whole: bool, operations: tuple[Operation, ...]) -> Calls:
        told.append((is_whole, [one.operation for one in operations]))
        return Calls(whole=is_whole, operations=())

    return Operations(say, kept=2, running=3)


def test_only_the_last_that_are_over_are_kept_and_so_many_may_run():
    async def run() -> None:
        made = ledger([])
        for _ in range(3):
            made.add(Operation(made.next_number()))
        with pytest.raises(CommandError, match="3 of these run already"):
            made.next_number()
        for one in made.all():
            one.is_over = True
        made.add(Operation(made.next_number()))
        assert [one.operation for one in made.all()] == [2, 3, 4]
        assert [one.operation for one in made.unfinished()] == [4]
        with pytest.raises(CommandError, match="number 1"):
            made.get(1)
        await made.close()

    asyncio.run(run())


def test_who_follows_is_told_all_once_and_then_what_changes_many_changes_at_once():
    told: list[tuple[bool, list[int]]] = []

    async def run() -> None:
        made, ear, other = ledger(told), Ear(), Ear()
        first, second = Operation(made.next_number()), Operation(made.next_number())
        made.add(first)
        made.add(second)
        made.follow(ear)
        assert told == [(True, [1, 2])]
        await until(lambda: len(told) == 2)
        for _ in range(100):
            made.changed(first)
        await until(lambda: len(told) == 3)
        assert told[2] == (False, [1])
        made.unfollow(ear)
        made.follow(other)
        made.changed(second)
        await until(lambda: len(other.events) == 2)
        assert len(ear.events) == 3
        await made.close()

    asyncio.run(run())
