"""Later: coroutines for whoever spins a node, now or once somebody does."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

from studio.ros.node.work import ReentrantCallbackGroup, Work

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine


class Later(Work):
    """Keeps coroutines until they are begun, beside each other and in their order.

    Between two `spin_once` nobody spins a node: what is handed in then must not be lost.
    """

    def __init__(self) -> None:
        super().__init__(ReentrantCallbackGroup())
        self._waiting: deque[Coroutine[Any, Any, Any]] = deque()
        self._destroyed = False

    def add(self, coroutine: Coroutine[Any, Any, Any]) -> None:
        """Have a coroutine carried out; from any thread. After the end it is closed."""
        self._waiting.append(coroutine)
        if self._destroyed:
            self._close_waiting()
        else:
            self.announce()

    @property
    def is_ready(self) -> bool:
        """Whether one was not begun."""
        return bool(self._waiting)

    def take(self) -> Callable[[], object] | None:
        """Give the oldest."""
        coroutine = self._oldest()
        return None if coroutine is None else lambda: coroutine

    def destroy(self) -> None:
        """Close those that were not begun."""
        self._destroyed = True
        self._close_waiting()

    def _close_waiting(self) -> None:
        while (coroutine := self._oldest()) is not None:
            coroutine.close()

    def _oldest(self) -> Coroutine[Any, Any, Any] | None:
        try:
            return self._waiting.popleft()
        except IndexError:
            return None
