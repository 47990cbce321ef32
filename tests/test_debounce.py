"""Work that waits runs as often as it must and no more."""

from __future__ import annotations

import asyncio

from studio.debounce import Debouncer, Throttle


def test_what_triggers_a_throttle_during_a_run_is_covered_by_one_more():
    async def run() -> None:
        runs = 0
        may_end, began, again = asyncio.Event(), asyncio.Event(), asyncio.Event()

        async def work() -> None:
            nonlocal runs
            runs += 1
            (again if began.is_set() else began).set()
            await may_end.wait()

        throttle = Throttle(work)
        throttle.trigger()
        await began.wait()
        for _ in range(5):
            throttle.trigger()
        may_end.set()
        await again.wait()
        await throttle.close()
        assert runs == 2

    asyncio.run(run())


def test_a_throttle_that_was_closed_runs_no_more_and_is_closed_again_in_peace():
    async def run() -> None:
        runs: list[int] = []

        async def work() -> None:
            runs.append(1)

        throttle = Throttle(work, first_s=60.0)
        await throttle.close()
        throttle.trigger()
        await throttle.close()
        await throttle.close()
        assert runs == []

    asyncio.run(run())


def test_a_debouncer_runs_once_after_the_last_of_many_triggers():
    async def run() -> None:
        runs: list[int] = []
        debouncer = Debouncer(lambda: runs.append(1), 0.0)
        for _ in range(5):
            debouncer.trigger()
        await debouncer.settled()
        assert runs == [1]

    asyncio.run(run())


def test_a_trigger_ends_work_that_is_under_way_and_has_it_done_anew():
    async def run() -> None:
        began, ended = asyncio.Event(), list[str]()

        async def work() -> None:
            try:
                if not began.is_set():
                    began.set()
                    await asyncio.Event().wait()
                ended.append("done")
            except asyncio.CancelledError:
                ended.append("given up")
                raise

        debouncer = Debouncer(work, 0.0)
        debouncer.trigger()
        await began.wait()
        debouncer.trigger()
        await debouncer.settled()
        assert ended == ["given up", "done"]

    asyncio.run(run())


def test_the_quiet_time_begins_when_all_is_ready():
    async def run() -> None:
        story: list[str] = []

        async def ready() -> None:
            story.append("ready")

        debouncer = Debouncer(lambda: story.append("work"), 0.0, ready)
        debouncer.trigger()
        await debouncer.settled()
        assert story == ["ready", "work"]

    asyncio.run(run())


def test_a_debouncer_that_was_cancelled_or_closed_does_not_run():
    async def run() -> None:
        runs: list[int] = []
        debouncer = Debouncer(lambda: runs.append(1), 0.0)
        debouncer.cancel()
        await debouncer.close()
        debouncer.trigger()
        debouncer.cancel()
        await debouncer.settled()
        debouncer.trigger()
        await debouncer.close()
        assert runs == []

    asyncio.run(run())
