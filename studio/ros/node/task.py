"""Task: a function or coroutine that an executor carries out, step by step."""

from __future__ import annotations

import asyncio
import inspect
from typing import TYPE_CHECKING, Any

from studio.ros.node.future import Future

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from studio.ros.node.executor import Executor


class Task(Future[Any]):
    """Becomes what the function returns; a coroutine goes on when what it awaits is done."""

    def __init__(
        self, handler: Callable[..., object] | Coroutine[Any, Any, Any], *args: Any,  # noqa: ANN401
        executor: Executor, **named: Any,  # noqa: ANN401
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
            self.cancel()  # what it awaited was given up, which is nobody's fault
        except BaseException as error:
            self.set_exception(error)
            raise

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
