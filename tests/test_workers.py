"""What every worker process has in common, on the one that is lightest."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.description.requests import CODEC
from studio.description.values import Edit, EditRequest, Failure
from studio.errors import WorkerDiedError, WorkerTimeoutError
from studio.workers import Worker, WorkerPool, kept_waiting_s
from tests.support import spending_worker
from tests.support.open_documents import until
from tests.support.spending_worker import Spend, Spent

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

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


def test_a_worker_whose_pipe_has_just_closed_has_died_on_every_loop():
    uvloop = pytest.importorskip("uvloop")  # the loop of the server, where there is one

    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        await worker.warm()
        process = worker._process  # pyright: ignore[reportPrivateUsage]
        assert process is not None
        assert process.stdin is not None
        process.stdin.transport.abort()
        await until(process.stdin.is_closing)
        await asyncio.sleep(0)
        with pytest.raises(WorkerDiedError):
            await worker.ask(REQUEST, Failure, 30)
        assert isinstance(await worker.ask(REQUEST, Failure, 30), Failure)
        await worker.close()

    for loops in (asyncio.new_event_loop, uvloop.new_event_loop):
        with asyncio.Runner(loop_factory=loops) as runner:
            runner.run(run())


def test_a_worker_that_is_closed_while_it_starts_leaves_no_process():
    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        asking = [asyncio.create_task(worker.ask(REQUEST, Failure, 30)) for _ in range(2)]
        await asyncio.sleep(0)
        await worker.close()
        assert worker.pid is None
        ended = await asyncio.gather(*asking, return_exceptions=True)
        assert [type(one) for one in ended] == [WorkerDiedError] * 2
        assert (worker.pid, worker.generation) == (None, 0)

    asyncio.run(run())


def test_a_worker_is_closed_once_its_process_has_ended_whoever_began_to_end_it():
    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        await worker.warm()
        pid = worker.pid
        asking = asyncio.create_task(worker.ask(REQUEST, Failure, 30))
        await asyncio.sleep(0)
        for _ in range(2):  # the second time while it ends the process
            asking.cancel()
            await asyncio.sleep(0)
        await worker.close()
        with pytest.raises(ProcessLookupError):
            os.kill(pid or 0, 0)

    asyncio.run(run())


@pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="asyncio waits for it in a thread")
def test_a_process_that_ended_by_itself_keeps_its_exit_code_however_late_it_is_noticed(
    monkeypatch: pytest.MonkeyPatch,
):
    async def run() -> int | None:
        if sys.version_info < (3, 12):  # since then it waits so by itself
            watcher = asyncio.PidfdChildWatcher()  # pyright: ignore[reportDeprecated]
            watcher.attach_loop(asyncio.get_running_loop())
            monkeypatch.setattr("asyncio.events.get_child_watcher", lambda: watcher)
        worker = Worker("xacro", "studio.description.worker", CODEC)
        await worker.warm()
        assert worker.pid is not None
        os.kill(worker.pid, signal.SIGTERM)
        # It has ended, and the loop has no turn to notice.
        os.waitid(os.P_PID, worker.pid, os.WEXITED | os.WNOWAIT)  # noqa: ASYNC222
        return await worker._end()  # pyright: ignore[reportPrivateUsage]

    assert asyncio.run(run()) == -signal.SIGTERM


def test_requests_that_wait_when_a_worker_is_closed_do_not_start_it_anew():
    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        await worker.warm()
        asking = [asyncio.create_task(worker.ask(REQUEST, Failure, 30)) for _ in range(3)]
        await asyncio.sleep(0)
        await worker.close()
        ended = await asyncio.gather(*asking, return_exceptions=True)
        assert [type(one) for one in ended] == [WorkerDiedError] * 3
        assert (worker.pid, worker.generation) == (None, 1)

    asyncio.run(run())


def test_requests_that_come_together_are_all_answered():
    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        answers = await asyncio.gather(*(worker.ask(REQUEST, Failure, 30) for _ in range(50)))
        assert {answer.problem.code for answer in answers} == {"no-session"}
        assert worker.generation == 1
        await worker.close()

    asyncio.run(run())


def test_a_worker_takes_no_module_from_the_folder_that_somebody_works_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "msgspec.py").write_text("raise SystemExit('taken from the workspace')\n")
    monkeypatch.chdir(tmp_path)

    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        answer = await worker.ask(REQUEST, Failure, 30)
        assert answer.problem.code == "no-session"
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


@pytest.mark.skipif(sys.platform == "win32", reason="there are no groups of processes")
def test_ctrl_c_in_the_terminal_does_not_reach_a_worker_however_young():
    uvloop = pytest.importorskip("uvloop")  # the loop of the server, where there is one

    async def run() -> None:
        worker = Worker("xacro", "studio.description.worker", CODEC)
        await worker.warm()
        assert worker.pid is not None
        assert os.getpgid(worker.pid) != os.getpgid(0)
        await worker.close()

    for loops in (asyncio.new_event_loop, uvloop.new_event_loop):
        with asyncio.Runner(loop_factory=loops) as runner:
            runner.run(run())


def spender() -> Worker:
    return Worker("spending", "tests.support.spending_worker", spending_worker.CODEC)


@contextmanager
def neighbours(pid: int, count: int) -> Generator[None]:
    """Processes without end that share one processor with this one."""
    core = min(os.sched_getaffinity(0))
    os.sched_setaffinity(pid, {core})
    busy = f"import os; os.sched_setaffinity(0, {{{core}}}); print(flush=True)\nwhile True: pass"
    command = [sys.executable, "-c", busy]
    others = [  # each a session, as the worker is: Linux shares a processor among those
        subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True)
        for _ in range(count)
    ]
    for other in others:
        assert other.stdout is not None
        other.stdout.readline()
    try:
        yield
    finally:
        for other in others:
            other.kill()
            other.communicate()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells how long a process waited")
def test_a_busy_machine_takes_none_of_the_time_that_a_request_has():
    async def run() -> None:
        worker = spender()
        await worker.ask(Spend(), Spent, 30)
        assert worker.pid is not None
        with neighbours(worker.pid, 5):
            began_s = asyncio.get_running_loop().time()
            before_s = kept_waiting_s(worker.pid)
            await worker.ask(Spend(working_s=0.3), Spent, 1.0)
            assert kept_waiting_s(worker.pid) > before_s
            assert asyncio.get_running_loop().time() - began_s > 1.0
        await worker.close()

    asyncio.run(run())


def test_who_sleeps_or_works_beyond_its_time_is_ended():
    async def run() -> None:
        worker = spender()
        await worker.ask(Spend(), Spent, 30)
        for late in (Spend(sleeping_s=60.0), Spend(working_s=60.0)):
            with pytest.raises(WorkerTimeoutError):
                await worker.ask(late, Spent, 0.3)
        await worker.close()

    asyncio.run(run())


def test_slow_requests_get_workers_of_their_own_that_end_when_nobody_waits():
    async def run() -> None:
        pool = WorkerPool(1, lambda _: spender(), most=3, slow_s=0.1)
        slow = [
            asyncio.create_task(pool.ask(Spend(sleeping_s=600.0), Spent, 600, "slow"))
            for _ in range(3)
        ]
        await until(lambda: len(pool.workers) == 2)
        for _ in range(3):
            await pool.ask(Spend(), Spent, 30, "other")  # the last worker is not for "slow"
        assert not any(one.done() for one in slow)
        for one in slow:
            one.cancel()
        await asyncio.gather(*slow, return_exceptions=True)
        await pool.ask(Spend(), Spent, 30, "other")
        assert len(pool.workers) == 1
        await pool.close()

    asyncio.run(run())


def test_an_owner_of_many_requests_keeps_another_waiting_for_one_of_them():
    async def run() -> None:
        pool = WorkerPool(1, lambda _: spender())
        ends: list[str] = []

        async def ask(owner: str) -> None:
            await pool.ask(Spend(), Spent, 30, owner)
            ends.append(owner)

        await asyncio.gather(*(ask("many") for _ in range(20)), ask("one"))
        assert ends.index("one") == 1
        await pool.close()

    asyncio.run(run())


def test_requests_that_wait_fail_when_their_pool_is_closed():
    async def run() -> None:
        pool = WorkerPool(1, lambda _: spender())
        asked = [asyncio.create_task(pool.ask(Spend(sleeping_s=600.0), Spent, 600)) for _ in "ab"]
        await until(lambda: pool.workers[0].pid is not None)
        await pool.close()
        fallen = await asyncio.gather(*asked, return_exceptions=True)
        assert [type(one) for one in fallen] == [WorkerDiedError] * 2
        assert pool.workers[0].pid is None

    asyncio.run(run())
