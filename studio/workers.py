"""Worker processes over pipes: one request, one answer, a time limit, a fresh process after a fall.

A worker is `python -m studio.<room>.worker`, never a fork (unsafe beside uvloop, viser and zenoh
threads) and never multiprocessing's spawn (it imports the command again). What goes over the pipe
is in `worker_process`.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
from collections import Counter
from typing import TYPE_CHECKING, TypeVar

from studio.errors import WorkerDiedError, WorkerTimeoutError
from studio.system import let_others_go_first, python_command
from studio.worker_process import FRAME_LENGTH

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable, Hashable

    from studio.worker_process import Codec

START_TIMEOUT_S = 20.0
"""Limit for a process to start, on a busy machine."""
_PATIENCE = 5
"""On a busy machine, a process may wait so many times its time limit in addition."""

Answer = TypeVar("Answer")


class Worker:
    """The parent's end of one worker process; started at the first `ask` or by `warm`.

    Requests queue up; one runs at a time. A late or dead worker is ended, the asker gets the error,
    and the next `ask` starts a fresh one: `generation` counts them. A caller that depends on the
    result of the request before takes the `turn` and asks by `ask_now`.
    """

    def __init__(
        self,
        name: str,
        module: str,
        codec: Codec,
        *arguments: str,
        others_first: bool = False,
    ) -> None:
        """Make one that starts a module, at low priority with `others_first`."""
        self.name, self.generation, self._others_first = name, 0, others_first
        self._command = python_command(module, *arguments)
        self._codec = codec
        self._process: asyncio.subprocess.Process | None = None
        self._is_up = False
        """Whether the process has reported that it is up."""
        self._closes = 0
        """How often it was closed: a request from before does not start it again."""
        self._lock = asyncio.Lock()
        self._starting: asyncio.Future[asyncio.subprocess.Process] | None = None
        self._ending: asyncio.Future[int] | None = None

    @property
    def pid(self) -> int | None:
        """Process id while it runs."""
        return self._process.pid if self._process else None

    @contextlib.asynccontextmanager
    async def turn(self) -> AsyncGenerator[None]:
        """Hold the pipe; those waiting get it in the order of asking.

        Raises:
            WorkerDiedError: The worker was closed meanwhile.
        """
        closes = self._closes
        async with self._lock:
            if closes != self._closes:
                raise WorkerDiedError(self.name, None)
            yield

    async def warm(self) -> None:
        """Start the process without asking it anything."""
        with contextlib.suppress(WorkerDiedError):
            async with self.turn():
                await self._ensure_process()

    async def ask(
        self, request: object, answer: type[Answer], timeout_s: float, *, starts: bool = True
    ) -> Answer:
        """Send one request when it is its turn, and wait for its answer.

        Args:
            request: One of the codec's types.
            answer: What the answer must be.
            timeout_s: Time for the answer, without what a busy machine kept the process waiting,
                and without the start of the process.
            starts: A process that is not running is started; else that is an error, for a request
                that means something only to the process that knows those before.

        Raises:
            WorkerTimeoutError: No answer in time; the process was ended.
            WorkerDiedError: The process ended, or answered what is not `answer`.
        """
        async with self.turn():
            return await self.ask_now(request, answer, timeout_s, starts=starts)

    async def ask_now(
        self, request: object, answer: type[Answer], timeout_s: float, *, starts: bool = True
    ) -> Answer:
        """As `ask`, for the holder of the `turn`."""
        if not starts and not self._is_running:
            raise WorkerDiedError(self.name, await self._end())
        process = await self._ensure_process()
        limit_s = START_TIMEOUT_S
        try:
            self._send(process, request)  # first: it works while we get ready to wait
            if not self._is_up:
                async with _time_to_run(process.pid, limit_s):
                    self._is_up = await self._receive(process) == b""
            limit_s = timeout_s
            async with _time_to_run(process.pid, limit_s):
                body = await self._receive(process)
            message = self._codec.unpack(body)
        except TimeoutError as error:
            await self._end()
            raise WorkerTimeoutError(self.name, limit_s) from error
        except (EOFError, ConnectionError, LookupError, ValueError) as error:
            raise WorkerDiedError(self.name, await self._end()) from error
        except asyncio.CancelledError:
            await self._end()  # its late answer must not be taken for the next one's
            raise
        if not isinstance(message, answer):
            raise WorkerDiedError(self.name, None)
        return message

    async def close(self) -> None:
        """End the process; safe to call twice. Running and waiting requests fail."""
        self._closes += 1
        if starting := self._starting:
            await asyncio.wait((starting,))
            if not starting.cancelled() and starting.exception() is None:
                self._process = starting.result()
        await self._end()

    async def _ensure_process(self) -> asyncio.subprocess.Process:
        if self._process is None or self._process.returncode is not None:
            self._is_up = False
            self._process = await self._start()
            self.generation += 1
        return self._process

    @property
    def _is_running(self) -> bool:
        return self._process is not None and self._process.returncode is None

    async def _start(self) -> asyncio.subprocess.Process:
        closes = self._closes
        starting = self._starting = asyncio.ensure_future(self._spawn())
        try:
            process = await asyncio.shield(starting)
        except asyncio.CancelledError:
            process = await starting  # else nothing would know of it and end it
            if closes == self._closes:
                self._process = process
            raise
        finally:
            self._starting = None
        if closes != self._closes:  # `close` ends it
            raise WorkerDiedError(self.name, None)
        return process

    async def _spawn(self) -> asyncio.subprocess.Process:
        process = await asyncio.create_subprocess_exec(
            *self._command,
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            limit=1 << 20,
            # Ctrl-C reaches a whole group: it would meet the worker before it can ignore it.
            start_new_session=True,
        )
        if self._others_first:
            let_others_go_first(process.pid)
        return process

    def _send(self, process: asyncio.subprocess.Process, request: object) -> None:
        assert process.stdin is not None
        try:
            process.stdin.write(self._codec.pack(request))
        except RuntimeError as error:  # uvloop's word for a pipe whose other end has just gone
            raise ConnectionResetError(str(error)) from error

    async def _receive(self, process: asyncio.subprocess.Process) -> bytes:
        assert process.stdin is not None
        assert process.stdout is not None
        await process.stdin.drain()
        (length,) = FRAME_LENGTH.unpack(await process.stdout.readexactly(FRAME_LENGTH.size))
        return await process.stdout.readexactly(length)

    async def _end(self) -> int | None:
        """End the process, or wait for its end: the task that began to end it may be cancelled."""
        process, self._process = self._process, None
        if process is not None:
            self._ending = asyncio.ensure_future(_killed(process))
        if self._ending is None:
            return None
        code = await asyncio.shield(self._ending)
        return None if process is None else code


async def _killed(process: asyncio.subprocess.Process) -> int:
    with contextlib.suppress(ProcessLookupError):
        _kill(process)
    assert process.stdout is not None
    with contextlib.suppress(RuntimeError):  # the asker reads it already
        await process.stdout.read()  # to its end, or asyncio holds the pipe for open
    return await process.wait()


def _kill(process: asyncio.subprocess.Process) -> None:
    """Kill a process; one that has ended by itself keeps its exit code.

    asyncio's own `kill` polls first, and so takes the code away from what waits for it, which then
    reports 255.
    """
    if sys.platform == "win32":
        process.kill()
    elif process.returncode is None:
        os.kill(process.pid, signal.SIGKILL)


@contextlib.asynccontextmanager
async def _time_to_run(pid: int, timeout_s: float) -> AsyncGenerator[None]:
    """Time out when a process had so long to run, however many others run beside it.

    Not by `wait_for`: an answer would come a task's turn later.
    """
    loop = asyncio.get_running_loop()
    began, had_waited = loop.time(), kept_waiting_s(pid)

    def check() -> None:
        nonlocal timer
        kept_s = min(kept_waiting_s(pid) - had_waited, _PATIENCE * timeout_s)
        left_s = began + timeout_s + kept_s - loop.time()
        if left_s > 0.01:
            timer = loop.call_later(left_s, check)
        else:
            limit.reschedule(loop.time())

    timer = loop.call_later(timeout_s, check)
    try:
        async with asyncio.timeout(None) as limit:
            yield
    finally:
        timer.cancel()


def kept_waiting_s(pid: int) -> float:
    """Return how long a process was ready to run but did not run, s; 0 where it is not counted.

    Source: Linux, Documentation/scheduler/sched-stats (ns, of its first thread).
    """
    try:
        with open(f"/proc/{pid}/schedstat", "rb") as counts:  # noqa: PTH123 - no path is made of it
            return int(counts.read().split()[1]) / 1e9
    except (OSError, ValueError, IndexError):
        return 0.0


class WorkerPool:
    """Several workers of one kind for independent requests, each asked for one answer at a time.

    Waiting requests are taken in turn by their owners. While some are slow the pool has one more
    worker for each of them, which is ended when nobody waits.

    Args:
        size: Workers that stay.
        make: Makes the worker of that number.
        most: Workers with those for slow requests; the last of them is only for owners without a
            running request. No more than `size` when it is not given.
        slow_s: A request that runs for longer is slow.
    """

    def __init__(
        self,
        size: int,
        make: Callable[[int], Worker],
        most: int | None = None,
        slow_s: float = 0.5,
    ) -> None:
        self._make, self._made = make, size
        self._size, self._most, self._slow_s = size, max(size, most or size), slow_s
        self._free = [make(number) for number in range(size)]
        self._busy: dict[Worker, tuple[Hashable, float]] = {}
        """The owner of the request that each works on, and since when, by the loop's clock."""
        self._waiting: list[tuple[Hashable, asyncio.Future[Worker]]] = []
        self._turns: dict[Hashable, int] = {}
        """Each owner's last turn, counted in turns of all."""
        self._timer: asyncio.TimerHandle | None = None

    @property
    def workers(self) -> tuple[Worker, ...]:
        """The present workers."""
        return (*self._busy, *self._free)

    async def warm(self) -> None:
        """Start all processes."""
        await asyncio.gather(*(worker.warm() for worker in self._free))

    async def ask(
        self, request: object, answer: type[Answer], timeout_s: float, owner: Hashable = None
    ) -> Answer:
        """Ask a worker that is free, as soon as there is one.

        Args:
            request: As for `Worker.ask`, as the two after it.
            answer: What the answer must be.
            timeout_s: Time for the answer, which begins when it is this request's turn.
            owner: Whose request it is: owners take turns.

        Raises:
            WorkerError: As `Worker.ask`, or the pool was closed meanwhile.
        """
        worker = await self._turn(owner)
        try:
            return await worker.ask(request, answer, timeout_s)
        finally:
            await self._give_back(worker)

    async def close(self) -> None:
        """End all processes. Running and waiting requests fail."""
        for _, turn in self._waiting:
            if not turn.done():
                turn.set_exception(WorkerDiedError("pool", None))
        self._waiting.clear()
        await asyncio.gather(*(worker.close() for worker in self.workers))

    async def _turn(self, owner: Hashable) -> Worker:
        turn: asyncio.Future[Worker] = asyncio.get_running_loop().create_future()
        self._waiting.append((owner, turn))
        self._hand_out()
        try:
            return await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled() and turn.exception() is None:
                await self._give_back(turn.result())
            self._waiting = [one for one in self._waiting if one[1] is not turn]
            raise

    def _hand_out(self) -> None:
        """Assign free workers to waiting requests."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        while self._waiting:
            at = self._next()
            owner = self._waiting[at][0]
            if self._is_full_for(owner) or not (self._free or self._may_grow()):
                return
            turn = self._waiting.pop(at)[1]
            if turn.done():
                continue
            worker = self._free.pop() if self._free else self._further()
            self._busy[worker] = (owner, asyncio.get_running_loop().time())
            self._turns[owner] = max(self._turns.values(), default=0) + 1
            turn.set_result(worker)

    def _next(self) -> int:
        """Return the first of an owner with few requests at work, who has had no turn for long."""
        at_work = Counter(owner for owner, _ in self._busy.values())

        def rank(at: int) -> tuple[int, int]:
            owner = self._waiting[at][0]
            return at_work[owner], self._turns.get(owner, 0)

        return min(range(len(self._waiting)), key=rank)

    def _is_full_for(self, owner: Hashable) -> bool:
        """Whether the only worker left, if any, is kept for owners who have none at work."""
        left = self._most - len(self._busy)
        owners = {one for one, _ in self._busy.values()}
        return left < 1 or (left == 1 and self._most > self._size and owner in owners)

    def _may_grow(self) -> bool:
        """Whether slow requests call for one more worker; if they may later, check again then."""
        loop = asyncio.get_running_loop()
        since = sorted(began_s for _, began_s in self._busy.values())
        slow_from_s = since[len(self._busy) - self._size] + self._slow_s
        if loop.time() >= slow_from_s:
            return True
        self._timer = loop.call_at(slow_from_s, self._hand_out)
        return False

    def _further(self) -> Worker:
        self._made += 1
        return self._make(self._made - 1)

    async def _give_back(self, worker: Worker) -> None:
        del self._busy[worker]
        self._free.append(worker)
        self._hand_out()
        if not self._busy:
            self._turns.clear()
        if worker in self._free and len(self._free) > self._size:
            self._free.remove(worker)
            await worker.close()
