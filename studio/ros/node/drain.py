"""Drain: the one thread that empties the rings of everything that comes in."""

from __future__ import annotations

import logging
import threading
import time
from typing import TYPE_CHECKING, Protocol, TypeVar, runtime_checkable

import zenoh

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.wire.door import Incoming

ItemT = TypeVar("ItemT")

LOOK_S = 0.002
"""Between two looks while data flows."""
IDLE_LOOK_S = 0.01
"""Between two looks when nothing came for a while."""
_FLOWS_S = 0.25

logger = logging.getLogger(__name__)


@runtime_checkable
class Source(Protocol):
    """Something whose ring is emptied; it is quick and never waits."""

    def drain(self) -> int:
        """Take in what came, and give how much that was."""
        ...


class Drain:
    """Looks into every ring in turn, every 2 ms while data flows and less often when none does.

    No Python runs on Zenoh's threads, so that a slow callback or a busy interpreter blocks no
    other topic of the link.
    """

    def __init__(self) -> None:
        self._sources: tuple[Source, ...] = ()
        self._lock = threading.Lock()
        self._stopped = threading.Event()
        self._flowed_s = time.monotonic()
        self._thread = threading.Thread(target=self._run, name="ros drain", daemon=True)
        self._thread.start()

    def add(self, source: Source) -> None:
        """Empty one more ring."""
        with self._lock:
            self._sources = (*self._sources, source)
        self.hurry()

    def remove(self, source: Source) -> None:
        """Leave a ring alone; again is harmless."""
        with self._lock:
            self._sources = tuple(one for one in self._sources if one is not source)

    def hurry(self) -> None:
        """Look often for a while: something is expected."""
        self._flowed_s = time.monotonic()

    def stop(self) -> None:
        """End the thread; rings are looked into no more."""
        self._stopped.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def _run(self) -> None:
        while not self._stopped.wait(self._pause_s()):
            came = 0
            for source in self._sources:
                came += _drained(source)
            if came:
                self.hurry()

    def _pause_s(self) -> float:
        flows = time.monotonic() - self._flowed_s < _FLOWS_S
        return LOOK_S if flows else IDLE_LOOK_S


def waiting_in(incoming: Incoming[ItemT], most: int) -> Iterator[ItemT]:
    """Take what waits in a ring; nothing when it was undeclared meanwhile by another thread."""
    for _ in range(most):
        try:
            item = incoming.try_recv()
        except zenoh.ZError:
            return
        if item is None:
            return
        yield item


def _drained(source: Source) -> int:
    try:
        return source.drain()
    except Exception:  # one source that fails must not silence all others
        logger.exception("what came in could not be taken")
        return 0
