"""MultiThreadedExecutor: carries out several pieces of work beside each other."""

from __future__ import annotations

import os
import queue
import threading
import time
from collections import deque
from typing import TYPE_CHECKING

from studio.ros.node.executor import Executor, Piece

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.context import Context

_LOOK_S = 0.05


class MultiThreadedExecutor(Executor):
    """Carries out work in `num_threads` threads; callback groups say what may run beside what.

    A piece is taken only when a thread is free for it, so that what waits stays where the depth
    of its subscription bounds it. What a callback raises is raised where the executor spins.
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
        with self._changed:
            while not self._free:
                if self._failures or self.is_shut_down or not self.context.ok():
                    return bool(not self.context.ok() or self._failures)
                if enough is not None and enough():
                    return False
                if end_s is not None and time.monotonic() >= end_s:
                    return False
                self._changed.wait(_LOOK_S)
        return True

    def _hand_over(self, piece: Piece) -> None:
        with self._changed:
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
            with self._changed:
                self._free += 1
                self._changed.notify_all()

    def _raise_failure(self) -> None:
        if self._failures:
            raise self._failures.popleft()
