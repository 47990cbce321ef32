"""A lookout looks as often as it must and no more."""

from __future__ import annotations

import asyncio

from studio.documents.lookout import Lookout


def test_what_is_doubted_during_a_look_is_looked_at_once_more():
    async def run() -> None:
        looks = 0
        may_end, began, again = asyncio.Event(), asyncio.Event(), asyncio.Event()

        async def look() -> None:
            nonlocal looks
            looks += 1
            (again if began.is_set() else began).set()
            await may_end.wait()

        lookout = Lookout(look)
        lookout.doubt()
        await began.wait()
        for _ in range(5):
            lookout.doubt()
        may_end.set()
        await again.wait()
        await lookout.close()
        assert looks == 2

    asyncio.run(run())


def test_one_that_was_closed_looks_no_more_and_is_closed_again_in_peace():
    async def run() -> None:
        looks: list[int] = []

        async def look() -> None:
            looks.append(1)

        lookout = Lookout(look, first_s=60.0)
        await lookout.close()
        lookout.doubt()
        await lookout.close()
        await lookout.close()
        assert looks == []

    asyncio.run(run())
