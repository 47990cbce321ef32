"""Drain: the one thread that empties the rings of everything that comes in."""

from __future__ import annotations

import logging
import threading
import time
from typing import TYPE_CHECKING, Protocol, runtime_checkable

if TYPE_CHECKING:
    from collections.abc import Iterable

PROMPT_PAUSE_S = 0.0005
"""Between two reads of rings that somebody waits for, while data flows."""
PAUSE_S = 0.002
"""Between two reads while data flows, or of rings that somebody waits for."""
STREAM_PAUSE_S = 0.004
"""Between two reads while so many samples come that each is one of many."""
IDLE_PAUSE_S = 0.01
"""Between two reads when nothing came for a while."""
_IDLE_S = (PAUSE_S, IDLE_PAUSE_S)
_FLOWS_S = 0.25
_REST = 5
_MANY = 8
"""Samples of one read, some 4,000 a second: half as many reads take a tenth less processor."""

logger = logging.getLogger(__name__)


@runtime_checkable
class Source(Protocol):
    """Something whose ring is emptied; it is quick and never waits."""

    def drain(self) -> int:
        """Take in what came, and return how much that was."""
        ...


class Drain:
    """Empties every ring in turn: every 2 ms where data flows, else every 10 ms.

    Those that somebody waits for are emptied more often: every half millisecond where data flows,
    else every 2 ms.

    No Python runs on Zenoh's threads, so that a slow callback or a busy interpreter blocks no
    other topic of the link.
    """

    def __init__(self) -> None:
        self._sources: tuple[Source, ...] = ()
        self._prompt: tuple[Source, ...] = ()
        self._flowing: dict[Source, float] = {}
        self._failed: set[Source] = set()
        self._lock = threading.Lock()
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="ros drain", daemon=True)
        self._thread.start()

    def add(self, source: Source) -> None:
        """Empty one more ring."""
        with self._lock:
            self._sources = (*self._sources, source)
        self.hurry(source)

    def remove(self, source: Source) -> None:
        """Empty a ring no more; again is harmless."""
        with self._lock:
            self._sources = tuple(one for one in self._sources if one is not source)
            self._prompt = tuple(one for one in self._prompt if one is not source)
            self._flowing.pop(source, None)
            self._failed.discard(source)

    def hurry(self, source: Source) -> None:
        """Empty a ring more often for a while: something is expected."""
        with self._lock:
            self._flowing[source] = time.monotonic() + _FLOWS_S

    def wait_for(self, source: Source) -> None:
        """Empty a ring as often as possible, until it is removed."""
        with self._lock:
            if source in self._sources and source not in self._prompt:
                self._prompt = (*self._prompt, source)

    def wait_no_more_for(self, source: Source) -> None:
        """Read a ring as often as all others; harmless where nobody waits for it."""
        with self._lock:
            self._prompt = tuple(one for one in self._prompt if one is not source)

    @property
    def is_flowing(self) -> bool:
        """Whether something came, or is expected, recently."""
        return bool(self._flowing)

    def stop(self) -> None:
        """End the thread; rings are emptied no more."""
        self._stopped.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def _run(self) -> None:
        read_all_s = read_s = rest_s = 0.0
        taken = 0
        while not self._stopped.is_set():
            prompt_s, pause_s = (PROMPT_PAUSE_S, _pause_s(taken)) if self._flowing else _IDLE_S
            # To wait for the event would take twice the processor of a plain sleep.
            time.sleep(min(max(prompt_s, rest_s), pause_s) if self._prompt else pause_s)
            now_s = time.monotonic()
            if self._prompt and now_s < read_s:
                self._read(self._prompt, now_s)
                rest_s = _REST * (time.monotonic() - now_s)
                continue
            read_s = now_s + pause_s
            if now_s < read_all_s:
                taken = self._read(tuple(self._flowing), now_s)
            else:
                taken = self._read(self._sources, now_s)
                self._calm_down(now_s)
                # With ten thousand rings, reads are less frequent, so that they do not take a core.
                took_s = time.monotonic() - now_s
                read_all_s = now_s + max(IDLE_PAUSE_S, _REST * took_s)

    def _read(self, sources: Iterable[Source], now_s: float) -> int:
        """Empty rings, and return how much was in them."""
        taken = 0
        for source in sources:
            if count := self._drained(source):
                self._flowing[source] = now_s + _FLOWS_S
                taken += count
        return taken

    def _drained(self, source: Source) -> int:
        try:
            return source.drain()
        except Exception:  # one source that fails must not silence all others
            if source not in self._failed:
                self._failed.add(source)
                logger.exception("samples could not be taken, which is logged once")
            return 0

    def _calm_down(self, now_s: float) -> None:
        """Read rings less often where nothing came for a while."""
        with self._lock:
            for source in [one for one, end_s in self._flowing.items() if end_s < now_s]:
                del self._flowing[source]


def _pause_s(taken: int) -> float:
    """Return how long to sleep after so many samples were read."""
    return STREAM_PAUSE_S if taken >= _MANY else PAUSE_S
