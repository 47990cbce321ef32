"""Executors: they carry out the work of nodes, in the thread that spins or in several."""

from __future__ import annotations

import inspect
import os
import queue
import threading
import time
from collections import deque
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self

from studio.errors import ExecutorTimeoutError, ExternalShutdownException
from studio.ros import strictness
from studio.ros.condition import Condition
from studio.ros.node.context import default_context
from studio.ros.node.task import Future, Task
from studio.ros.node.work import Home, Work

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator, Sequence

    from studio.ros.node.context import Context

_WAIT_MAX_S = 3_600.0
_CHECK_EVERY_S = 0.05


class ExecutorNode(Home, Protocol):
    """The part of a node that an executor uses."""

    @property
    def executor(self) -> Executor | None:
        """The executor that carries out its work, None until it spins."""
        ...

    @executor.setter
    def executor(self, executor: Executor | None) -> None: ...

    @property
    def all_work(self) -> list[Work]:
        """Its work: subscriptions, timers and others."""
        ...


class Piece(NamedTuple):
    """A callable to run, and the work it is taken from; a task has none.

    A tuple, for it is made fastest: there is one for every message.
    """

    run: Callable[[], object]
    work: Work | None = None


class Executor:
    """Carries out what is ready, in the order in which it became so.

    Work announces itself when it is ready, so that nothing is polled. `SingleThreadedExecutor`
    runs pieces in the thread that spins, `MultiThreadedExecutor` in threads of its own.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        self.context = context or default_context()
        self.is_shut_down = self._is_spinning = False
        # Taken by its own name: a condition takes twice as long, and Ctrl-C may come within it.
        self._lock = threading.RLock()
        self._changed = Condition(self._lock)
        self._nodes: list[ExecutorNode] = []
        self._ready: deque[Work | Task] = deque()
        self._queued: set[Work] = set()
        self._held: set[Work] = set()
        self._due: set[Work] = set()
        self._tasks: set[Task] = set()
        self.context.on_end(self.wake)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()

    def add_node(self, node: ExecutorNode) -> bool:
        """Carry out a node's work, which another executor does no more; whether it is new."""
        with self._lock:
            if self.is_shut_down or node in self._nodes:
                return False
            self._nodes.append(node)
        node.executor = self
        for work in node.all_work:
            self.adopt(work)
        return True

    def remove_node(self, node: ExecutorNode) -> None:
        """Carry out a node's work no more."""
        with self._lock:
            if node not in self._nodes:
                return
            self._nodes.remove(node)
        if node.executor is self:
            node.executor = None
        for work in node.all_work:
            self.forget(work)

    def get_nodes(self) -> list[ExecutorNode]:
        """Return the nodes whose work is carried out."""
        with self._lock:
            return list(self._nodes)

    def adopt(self, work: Work) -> None:
        """Carry out a piece of work of a node."""
        if work.is_timed:
            with self._lock:
                self._due.add(work)
                self._changed.notify()
        if work.is_ready:
            self.announce(work)

    def forget(self, work: Work) -> None:
        """Remove work from what is due."""
        with self._lock:
            self._due.discard(work)
            if work in self._queued:
                self._queued.remove(work)
                self._ready.remove(work)
            self._held.discard(work)
            work.group.forget(work)

    def announce(self, work: Work) -> None:
        """Note that work is ready; thread-safe."""
        with self._lock:
            # A node that was removed meanwhile announces its work to its next executor.
            if work.home in self._nodes:
                self._held.discard(work)
                self._queue(work)
                self._changed.notify()

    def create_task(
        self,
        callback: Callable[..., object] | Coroutine[Any, Any, Any],
        *args: Any,  # noqa: ANN401
        **named: Any,  # noqa: ANN401
    ) -> Task:
        """Carry out a function or coroutine; the task becomes what it returns."""
        task = Task(callback, *args, executor=self, **named)
        self._keep(task)
        self.resume(task)
        return task

    def create_future(self) -> Future[Any]:
        """Return a future whose callbacks are carried out here."""
        return Future(executor=self)

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | None = None,
        nodes: Sequence[ExecutorNode] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task, Work | None, object]:
        """Wait for a piece of work: what carries it out when it is called, the work and its node.

        For executors of a user's own, which call it in a thread of their choice.

        Raises:
            ExecutorTimeoutError: None is ready in time, or the condition came true.
        """
        del nodes
        piece = self._next(timeout_sec, condition)
        if piece is None:
            raise ExecutorTimeoutError
        task = Task(partial(self._carry_out, piece), executor=self)
        return task, piece.work, None if piece.work is None else piece.work.home

    def resume(self, task: Task) -> None:
        """Continue a task; thread-safe."""
        with self._lock:
            self._ready.append(task)
            self._changed.notify()

    def wake(self) -> None:
        """Wake the spinning thread, which checks again whether to go on; thread-safe."""
        with self._lock:
            self._changed.notify_all()

    def spin(self) -> None:
        """Carry out work until the context ends or the executor is shut down.

        Raises:
            ExternalShutdownException: The process was asked to end.
        """
        with self._alone():
            while self.context.ok() and not self.is_shut_down:
                self._spin_once(None, None)

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Carry out one piece of work, or none when none is ready in time.

        Raises:
            ExternalShutdownException: The process was asked to end.
        """
        with self._alone():
            self._spin_once(timeout_sec, None)

    def spin_until_future_complete(
        self, future: Future[Any], timeout_sec: float | None = None
    ) -> None:
        """Carry out work until a future is done, or that long.

        Raises:
            ExternalShutdownException: The process was asked to end.
        """
        future.listen(self.wake)
        try:
            with self._alone():
                for left_s in _left(timeout_sec):
                    if future.done() or not self.context.ok() or self.is_shut_down:
                        return
                    self._spin_once(left_s, future.done)
        finally:
            future.unlisten(self.wake)

    def spin_once_until_future_complete(
        self, future: Future[Any], timeout_sec: float | None = None
    ) -> None:
        """Carry out one piece of work unless a future is done."""
        future.listen(self.wake)
        try:
            self._spin_once(timeout_sec, future.done)
        finally:
            future.unlisten(self.wake)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Carry out no more; nodes are let go of, not destroyed. Whether all pieces ended."""
        del timeout_sec
        self.is_shut_down = True
        for node in self.get_nodes():
            self.remove_node(node)
        self._tasks.clear()
        self.context.forget_end(self.wake)
        self.wake()
        return True

    @property
    def is_spinning(self) -> bool:
        """Whether a thread of a user's program spins it."""
        return self._is_spinning

    @contextmanager
    def _alone(self) -> Generator[None]:
        """Spin, unless it spins already: within a callback, or in another thread.

        The studio's own nodes may, users' programs may not, as in rclpy.

        Raises:
            RuntimeError: A user's program spins what spins.
        """
        if not strictness.is_begun():
            yield
            return
        with self._lock:
            if self._is_spinning:
                raise RuntimeError("Executor is already spinning")
            self._is_spinning = True
        try:
            yield
        finally:
            self._is_spinning = False

    def _keep(self, task: Task) -> None:
        """Hold a task until it is done: nothing else may refer to it."""
        self._tasks.add(task)
        task.listen(lambda: self._tasks.discard(task))

    def _spin_once(self, timeout_s: float | None, enough: Callable[[], bool] | None) -> None:
        piece = self._next(timeout_s, enough)
        if piece is not None:
            self._carry_out(piece)

    def _next(self, timeout_s: float | None, enough: Callable[[], bool] | None) -> Piece | None:
        """Wait for a piece; None when the time is over, `enough()` is true or the executor ends."""
        end_s = None if timeout_s is None or timeout_s < 0 else time.monotonic() + timeout_s
        with self._lock:
            while True:
                if self._due:
                    self._queue_due()
                piece = self._pop()
                if piece is not None:
                    return piece
                if self.is_shut_down or (enough is not None and enough()):
                    return None
                if not self.context.ok():
                    raise ExternalShutdownException
                now_s = time.monotonic()
                if end_s is not None and now_s >= end_s:
                    return None
                self._changed.wait(self._pause_s(now_s, end_s))

    def _pop(self) -> Piece | None:
        while self._ready:
            work = self._ready.popleft()
            if isinstance(work, Task):
                return Piece(work.step)
            self._queued.discard(work)
            if not work.group.begin(work):
                self._held.add(work)
                continue
            run = work.take()
            if run is not None:
                if work.is_ready:
                    self._queue(work)
                return Piece(run, work)
            # What was ready was overwritten, or taken back.
            following = work.group.end()
            if following is not None:
                return Piece(following.announce)
        return None

    def _queue(self, work: Work) -> None:
        if work not in self._queued:
            self._queued.add(work)
            self._ready.append(work)

    def _carry_out(self, piece: Piece) -> None:
        """Run a piece; what an asynchronous callback awaits keeps its group taken."""
        run, work = piece
        suspended = False
        try:
            result = run()
            if result is not None and inspect.iscoroutine(result):
                task = Task(result, executor=self)
                self._keep(task)
                if work is not None:
                    task.listen(lambda: _end(work))
                    suspended = True
                task.step()
        finally:
            if work is not None and not suspended:
                _end(work)

    def _queue_due(self) -> None:
        for work in self._due - self._held:
            if work.is_ready:
                self._queue(work)

    def _pause_s(self, now_s: float, end_s: float | None) -> float:
        times_s = [due_s for work in self._due - self._held if (due_s := work.due_s) is not None]
        if end_s is not None:
            times_s.append(end_s)
        return min(_WAIT_MAX_S, max(0.0, min(times_s, default=now_s + _WAIT_MAX_S) - now_s))


class SingleThreadedExecutor(Executor):
    """Carries out work in the thread that spins."""


def _end(work: Work) -> None:
    """Announce the next work of a group to the executor of its node."""
    following = work.group.end()
    if following is not None:
        following.announce()


def _left(timeout_s: float | None) -> Any:  # noqa: ANN401
    """Yield what is left of a time until it is over; None for ever."""
    if timeout_s is None or timeout_s < 0:
        while True:
            yield None
    end_s = time.monotonic() + timeout_s
    yield timeout_s
    while (left_s := end_s - time.monotonic()) > 0:
        yield left_s


class MultiThreadedExecutor(Executor):
    """Runs callbacks in `num_threads` threads; callback groups decide what may run concurrently.

    A piece is taken only when a thread is free for it, so that samples wait where the depth of
    their subscription bounds them. What a callback raises is raised where the executor spins.
    """

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._threads_max = max(2, os.cpu_count() or 2) if num_threads is None else num_threads
        if self._threads_max < 1:
            raise ValueError("an executor needs a thread")
        self._threads: list[threading.Thread] = []
        self._given: queue.SimpleQueue[Piece | None] = queue.SimpleQueue()
        self._free = self._threads_max
        self._failures: deque[BaseException] = deque()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Carry out no more, and wait for the pieces that run; whether all ended in time."""
        super().shutdown()
        threads, self._threads = self._threads, []
        for _ in threads:
            self._given.put(None)
        end_s = None if timeout_sec is None else time.monotonic() + timeout_sec
        for thread in threads:
            if thread is not threading.current_thread():
                thread.join(None if end_s is None else max(0.0, end_s - time.monotonic()))
        return not any(thread.is_alive() for thread in threads)

    def _spin_once(self, timeout_s: float | None, enough: Callable[[], bool] | None) -> None:
        self._raise_failure()
        if not self._wait_for_thread(timeout_s, enough):
            return

        def is_enough() -> bool:
            return bool(self._failures) or (enough is not None and enough())

        piece = self._next(timeout_s, is_enough)
        if piece is not None:
            self._hand_over(piece)
        self._raise_failure()

    def _wait_for_thread(self, timeout_s: float | None, enough: Callable[[], bool] | None) -> bool:
        """Wait until a thread is free; False when the time is over, or there is enough."""
        end_s = None if timeout_s is None or timeout_s < 0 else time.monotonic() + timeout_s
        with self._lock:
            while not self._free:
                if self._failures or self.is_shut_down or not self.context.ok():
                    return bool(not self.context.ok() or self._failures)
                if enough is not None and enough():
                    return False
                if end_s is not None and time.monotonic() >= end_s:
                    return False
                self._changed.wait(_CHECK_EVERY_S)
        return True

    def _hand_over(self, piece: Piece) -> None:
        with self._lock:
            self._free -= 1
            if len(self._threads) < self._threads_max - self._free:
                thread = threading.Thread(target=self._work, name="ros executor", daemon=True)
                self._threads.append(thread)
                thread.start()
        self._given.put(piece)

    def _work(self) -> None:
        while (piece := self._given.get()) is not None:
            try:
                self._carry_out(piece)
            except BaseException as error:  # noqa: BLE001  # raised again where it spins
                self._failures.append(error)
            with self._lock:
                self._free += 1
                self._changed.notify_all()

    def _raise_failure(self) -> None:
        if self._failures:
            raise self._failures.popleft()
