from __future__ import annotations

import asyncio
import os
from pathlib import Path

import pytest

from studio.description.language.questions import OutlineQuery
from studio.description.values import OpenRequest, ReadPolicy
from studio.documents.copies.evaluators import Evaluators, SharedWorker
from studio.errors import WorkerDiedError

URDF = '<robot name="r"><link name="base"/></robot>'


class Noted(SharedWorker):
    """Notes when its process was given up, and has none."""

    def __init__(self, evaluators: Evaluators) -> None:
        super().__init__(evaluators)
        self.rests = 0

    async def rest(self) -> None:
        self.rests += 1
        await asyncio.sleep(0)


def test_a_worker_keeps_its_process_while_nobody_waits_and_the_one_least_used_gives_it_up():
    async def run() -> None:
        pool = Evaluators(2)
        one, two, three = (Noted(pool) for _ in range(3))
        for worker in (one, two, one, one):
            async with pool.turn(worker):
                pass
        assert (one.rests, two.rests) == (0, 0)
        async with pool.turn(three):
            pass
        assert (one.rests, two.rests, three.rests) == (0, 1, 0)

    asyncio.run(run())


def test_turns_are_taken_in_the_order_of_asking_though_one_asks_without_end():
    async def run() -> None:
        pool, order = Evaluators(1), list[str]()
        greedy, others = Noted(pool), [Noted(pool) for _ in range(3)]

        async def ask(name: str, worker: Noted) -> None:
            async with pool.turn(worker):
                order.append(name)
                await asyncio.sleep(0)

        async def ask_without_end() -> None:
            for _ in range(5):
                await ask("greedy", greedy)

        first = asyncio.create_task(ask_without_end())
        await asyncio.sleep(0)
        await asyncio.gather(first, *(ask(str(n), one) for n, one in enumerate(others)))
        # Before the others asked it had two turns; then each has its own before the next.
        assert order[:5] == ["greedy", "greedy", "0", "1", "2"]
        assert order.count("greedy") == 5

    asyncio.run(run())


def test_no_more_than_the_limit_are_at_work_and_who_is_cancelled_keeps_no_place():
    async def run() -> None:
        pool, at_work, most = Evaluators(3), 0, 0

        async def work(worker: Noted) -> None:
            nonlocal at_work, most
            for _ in range(5):
                async with pool.turn(worker):
                    at_work += 1
                    most = max(most, at_work)
                    await asyncio.sleep(0.001)
                    at_work -= 1

        tasks = [asyncio.create_task(work(Noted(pool))) for _ in range(20)]
        await asyncio.sleep(0.005)
        for task in tasks[::3]:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        assert most == 3
        late = Noted(pool)
        async with asyncio.timeout(60), pool.turn(late):
            pass

    asyncio.run(run())


@pytest.mark.skipif(not hasattr(os, "getpriority"), reason="priorities are of Unix")
def test_a_process_goes_behind_all_others_and_its_robot_comes_back_after_it_was_given_up(
    tmp_path: Path,
):
    files = [tmp_path / f"{name}.urdf" for name in ("one", "two")]
    for file in files:
        file.write_text(URDF)

    async def run() -> None:
        pool = Evaluators(1)
        one, two = pool.worker(), pool.worker()
        policy = ReadPolicy(roots=(str(tmp_path),), packages={}, environment={}, trusted=False)
        for worker, file in ((one, files[0]), (two, files[1]), (one, files[0])):
            answer = await worker.open(OpenRequest(str(file), {}, policy, {}))
            assert "base" in str(answer)
            assert worker.pid is not None
            assert os.getpriority(os.PRIO_PROCESS, worker.pid) >= 10
            group = Path(f"/proc/{worker.pid}/autogroup")
            assert not group.exists() or group.read_text().rstrip().endswith("nice 10")
        assert (two.pid, two.needs_reopen) == (None, True)
        await one.close()
        await two.close()

    asyncio.run(run())


def test_a_question_that_waits_while_its_process_is_given_up_is_asked_again(tmp_path: Path):
    files = [tmp_path / f"{name}.urdf" for name in ("one", "two")]
    for file in files:
        file.write_text(URDF)

    async def run() -> None:
        pool = Evaluators(1)
        one, two = pool.worker(), pool.worker()
        policy = ReadPolicy(roots=(str(tmp_path),), packages={}, environment={}, trusted=False)
        await one.open(OpenRequest(str(files[0]), {}, policy, {}))
        with pytest.raises(WorkerDiedError):  # a document opens its robot again, and asks again
            await asyncio.gather(
                one.query(OutlineQuery()), two.open(OpenRequest(str(files[1]), {}, policy, {}))
            )
        await one.close()
        await two.close()

    asyncio.run(run())
