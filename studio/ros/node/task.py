"""Future, a result that is set once, and Task, a function that an executor carries out."""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import logging
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar, cast

from studio.ros import strictness
from studio.ros.condition import Condition

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator


ResultT = TypeVar("ResultT")

logger = logging.getLogger(__name__)


class TaskExecutor(Protocol):
    """The part of an executor that futures and tasks use."""

    @property
    def is_shut_down(self) -> bool:
        """Whether it carries out no more."""
        ...

    def create_task(self, callback: Callable[..., object], *args: Any) -> object:  # noqa: ANN401
        """Run a function."""
        ...

    def resume(self, task: Task) -> None:
        """Continue a task; thread-safe."""
        ...


class Future(Generic[ResultT]):
    """A result or an exception, set once; thread-safe; the names are rclpy's.

    `await` works in a callback that an executor carries out, and in asyncio.
    """

    def __init__(self, *, executor: TaskExecutor | None = None) -> None:
        self._executor = executor
        self._changed = Condition()
        self._done = self._cancelled = False
        self._result: ResultT | None = None
        self._exception: BaseException | None = None
        self._callbacks: list[Callable[[Any], object]] = []
        self._listeners: list[Callable[[], object]] = []

    def done(self) -> bool:
        """Whether it has a result or an exception, or was cancelled."""
        return self._done

    def cancelled(self) -> bool:
        """Whether it was cancelled."""
        return self._cancelled

    def cancel(self) -> None:
        """Cancel it, which ends all waits; do nothing when it is done."""
        self._settle(cancelled=True)

    def result(self) -> ResultT:
        """Return the result, None while it is not done; an exception is raised."""
        if self._exception is not None:
            raise self._exception
        return cast("ResultT", self._result)

    def exception(self) -> BaseException | None:
        """Return the exception, None without."""
        return self._exception

    def set_result(self, result: ResultT) -> None:
        """Set the result; nothing when it is done already."""
        self._settle(result=result)

    def set_exception(self, exception: BaseException) -> None:
        """Set the exception, which `result` raises; nothing when it is done already."""
        self._settle(exception=exception)

    def add_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Call back with this future when it is done, by the executor where there is one."""
        with self._changed:
            if not self._done:
                self._callbacks.append(callback)
                return
        self._call_back(callback)

    def remove_done_callback(self, callback: Callable[[Any], object]) -> bool:
        """Do not call back; whether it was to be called."""
        with self._changed:
            if callback not in self._callbacks:
                return False
            self._callbacks.remove(callback)
            return True

    def listen(self, listener: Callable[[], object]) -> None:
        """Call a listener when it is done, in the thread that settles it; it must not wait."""
        with self._changed:
            if not self._done:
                self._listeners.append(listener)
                return
        listener()

    def unlisten(self, listener: Callable[[], object]) -> None:
        """Do not call a listener; harmless when it was called already."""
        with self._changed:
            if listener in self._listeners:
                self._listeners.remove(listener)

    def wait(self, timeout_s: float | None = None) -> bool:
        """Block until it is done, or that long; whether it is. Never within a callback."""
        with self._changed:
            return self._changed.wait_for(lambda: self._done, timeout_s)

    def __await__(self) -> Generator[Any, None, ResultT]:
        if not self._done and _in_asyncio():
            strictness.would_fail(
                "asyncio cannot await a future of rclpy",
                "await it in a coroutine that an executor runs, such as a callback",
            )
            yield from self._wait_in_loop()
        while not self._done:
            yield self
        if self._cancelled:
            raise asyncio.CancelledError
        return self.result()

    def _wait_in_loop(self) -> Generator[Any, None, None]:
        loop = asyncio.get_running_loop()
        there: asyncio.Future[None] = loop.create_future()

        def wake() -> None:
            if not there.done():
                there.set_result(None)

        def listener() -> None:
            if not loop.is_closed():
                loop.call_soon_threadsafe(wake)

        self.listen(listener)
        try:
            yield from there.__await__()
        finally:  # a wait that was given up leaves nothing behind
            self.unlisten(listener)

    def _settle(
        self,
        *,
        result: ResultT | None = None,
        exception: BaseException | None = None,
        cancelled: bool = False,
    ) -> None:
        with self._changed:
            if self._done:
                return
            self._result, self._exception, self._cancelled = result, exception, cancelled
            self._done = True
            callbacks, self._callbacks = self._callbacks, []
            listeners, self._listeners = self._listeners, []
            self._changed.notify_all()
        for listener in listeners:
            listener()
        for callback in callbacks:
            self._call_back(callback)

    def _call_back(self, callback: Callable[[Any], object]) -> None:
        executor = self._executor
        if executor is not None and not executor.is_shut_down:
            executor.create_task(callback, self)
            return
        try:
            callback(self)
        except Exception:  # the thread that settles it has nothing to do with the callback
            logger.exception("a callback of a future failed")


def _in_asyncio() -> bool:
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True


class Task(Future[Any]):
    """Becomes what the function returns; a coroutine goes on when what it awaits is done."""

    def __init__(
        self, handler: Callable[..., object] | Coroutine[Any, Any, Any], *args: Any,  # noqa: ANN401
        executor: TaskExecutor, **named: Any,  # noqa: ANN401
    ) -> None:  # fmt: skip
        super().__init__(executor=executor)
        self._home = executor
        self._coroutine: Coroutine[Any, Any, Any] | None = None
        self._begin: Callable[[], object] | None = None
        if inspect.iscoroutine(handler):
            self._coroutine = handler
        elif callable(handler):
            self._begin = lambda: handler(*args, **named)
        else:
            raise TypeError("a task is a function or a coroutine")

    def step(self) -> None:
        """Carry out what can be; of the executor.

        Raises:
            BaseException: What the function raised, which the task keeps too.
        """
        if self.done():
            self._close()
            return
        try:
            if self._begin is not None:
                begin, self._begin = self._begin, None
                result = begin()
                if not inspect.iscoroutine(result):
                    self.set_result(result)
                    return
                self._coroutine = result
            self._go_on()
        except asyncio.CancelledError:
            self.cancel()  # what it awaited was cancelled, which is no error
        except BaseException as error:
            self.set_exception(error)
            raise

    def __call__(self) -> None:
        """Carry out what can be; what is raised is kept, and given by `exception`."""
        with contextlib.suppress(Exception):
            self.step()

    def _go_on(self) -> None:
        coroutine = self._coroutine
        if coroutine is None:
            return
        try:
            awaited = coroutine.send(None)
        except StopIteration as stop:
            self.set_result(stop.value)
            return
        if isinstance(awaited, Future):
            awaited.listen(lambda: self._home.resume(self))
        elif awaited is None:
            self._home.resume(self)
        else:
            coroutine.close()
            raise RuntimeError(
                "a callback of a node awaits futures of nodes only: what asyncio makes belongs "
                "into asyncio"
            )

    def _close(self) -> None:
        if self._coroutine is not None:
            self._coroutine.close()
