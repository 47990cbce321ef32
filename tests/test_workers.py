"""What every worker process has in common, on the one that is lightest."""

from __future__ import annotations

import asyncio

import pytest

from studio.description.codec import CODEC
from studio.description.values import Edit, EditRequest, Failure
from studio.errors import WorkerDiedError
from studio.workers import Worker

REQUEST = EditRequest((Edit("/nowhere", 0, 0, b""),))


def test_a_worker_that_ended_is_started_anew_by_the_next_request():
    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        first = await worker.ask(REQUEST, Failure, 30)
        await worker.close()
        assert await worker.ask(REQUEST, Failure, 30) == first
        assert worker.generation == 2
        await worker.close()

    asyncio.run(run())


def test_requests_that_come_together_are_all_answered():
    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        answers = await asyncio.gather(*(worker.ask(REQUEST, Failure, 30) for _ in range(50)))
        assert {answer.problem.code for answer in answers} == {"no-session"}
        assert worker.generation == 1
        await worker.close()

    asyncio.run(run())


def test_a_request_that_means_nothing_to_a_new_process_starts_none():
    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        await worker.ask(REQUEST, Failure, 30)
        await worker.close()
        with pytest.raises(WorkerDiedError):
            await worker.ask(REQUEST, Failure, 30, starts=False)
        assert (worker.pid, worker.generation) == (None, 1)

    asyncio.run(run())
