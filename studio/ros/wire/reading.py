"""A thread that reads what comes in and hands it on in batches, until that is undeclared."""

from __future__ import annotations

import logging
import threading
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.wire.door import Incoming

ItemT = TypeVar("ItemT")

_log = logging.getLogger(__name__)

BATCH_MAX = 512
_END_TIMEOUT_S = 1.0


class ReadingThread(Generic[ItemT]):
    """Sleeps in Zenoh until something comes, so that it costs nothing and is never late.

    Zenoh's own threads only fill the queue: what is slow here holds up nobody else. A batch that
    cannot be taken is logged, and the next one is read.
    """

    def __init__(
        self, name: str, source: Incoming[ItemT], handle: Callable[[list[ItemT]], None]
    ) -> None:
        self._source, self._handle = source, handle
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Take the source back and end; again is harmless, and so is a session that has ended."""
        self._source.undeclare()
        if self._thread is not threading.current_thread():
            self._thread.join(_END_TIMEOUT_S)

    def _run(self) -> None:
        for first in self._source:
            batch = [first]
            while len(batch) < BATCH_MAX and (item := self._source.try_recv()) is not None:
                batch.append(item)
            try:
                self._handle(batch)
            except Exception:  # noqa: BLE001 - a listener of any room may raise anything
                _log.exception("%s could not take what came", self._thread.name)
