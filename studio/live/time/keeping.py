"""Keeping: when the last minutes of the live system are kept, and what of it in any case."""

from __future__ import annotations

import logging
import threading
import time
from typing import TYPE_CHECKING, Final

from studio.live.topics.request import Request

if TYPE_CHECKING:
    from studio.live.time.past import LivePast
    from studio.live.topics.shared_source import SharedSource
    from studio.live.topics.subscription import Subscription

ALWAYS: Final = (
    Request("/tf", latched=False, depth=100, waiting_max=1),
    Request("/tf_static", latched=True, depth=100, waiting_max=1),
    Request("/joint_states", latched=False, depth=5, waiting_max=1),
    Request("/robot_description", latched=True, depth=1, waiting_max=1),
    Request("/rosout", latched=False, depth=1_000, waiting_max=1),
    Request("/diagnostics", depth=100, waiting_max=1),
    Request("/parameter_events", depth=1_000, waiting_max=1),
    Request("/clock", latched=False, depth=1, waiting_max=1),
)
"""Kept while somebody publishes them: without them no past moment can be shown.

Of `/rosout` only what comes: what nodes said before would stand at the time of subscribing.
"""
_TICK_S: Final = 0.1
_LEFT_S: Final = 60.0
"""After so long without a page all is forgotten; a reload is quicker than that."""
_PUBLISHERS_EVERY_S: Final = 5.0
_SET_BACK_NS: Final = -1_000_000_000
"""A clock that is set back further would mix up the past."""

_log = logging.getLogger(__name__)


class Keeping:
    """Keeps while there is a connection and a page, in a thread that starts with the first page.

    Args:
        past: Where it is kept.
        source: The topics of the live system.
    """

    def __init__(self, past: LivePast, source: SharedSource) -> None:
        self._past, self._source = past, source
        self._pages = 0
        self._left_s = float("-inf")
        self._due = threading.Event()
        self._closed = False
        self._thread: threading.Thread | None = None
        self._subscriptions: list[Subscription] = []
        self._epoch = source.epoch
        self._noted_s = 0.0
        self._clock_ns = _clock_ns()

    def check(self, pages: int) -> None:
        """So many pages are there, and perhaps another connection."""
        if self._pages and not pages:
            self._left_s = time.monotonic()
        self._pages = pages
        if pages and self._thread is None and self._past.size_max and not self._closed:
            self._thread = threading.Thread(target=self._run, name="past", daemon=True)
            self._thread.start()
        self._due.set()

    def close(self) -> None:
        """Keep nothing more; it waits for the thread."""
        self._closed = True
        self._due.set()
        if self._thread is not None:
            self._thread.join()

    def _is_wanted(self) -> bool:
        is_seen = self._pages > 0 or time.monotonic() - self._left_s < _LEFT_S
        return is_seen and self._source.connection != "none" and not self._closed

    def _run(self) -> None:
        while not self._closed:
            try:
                wanted = self._is_wanted()
                self._step(wanted=wanted)
            except Exception:  # noqa: BLE001 - what fails once must not end the rest
                wanted = True
                _log.exception("The last minutes could not be kept.")
            self._due.wait(_TICK_S if wanted else None)
            self._due.clear()
        self._step(wanted=False)

    def _step(self, *, wanted: bool) -> None:
        if wanted != self._past.is_keeping:
            self._past.keep(keeping=wanted)
            self._subscribe(wanted=wanted)
        elif self._epoch != self._source.epoch or self._is_set_back():
            self._past.clear()
        self._epoch = self._source.epoch
        if wanted:
            self._past.collect()
            self._note_publishers()

    def _subscribe(self, *, wanted: bool) -> None:
        for one in self._subscriptions:
            one.close()
        self._subscriptions = [self._source.subscribe(one) for one in ALWAYS] if wanted else []

    def _is_set_back(self) -> bool:
        before, self._clock_ns = self._clock_ns, _clock_ns()
        return self._clock_ns - before < _SET_BACK_NS

    def _note_publishers(self) -> None:
        if time.monotonic() - self._noted_s > _PUBLISHERS_EVERY_S:
            self._noted_s = time.monotonic()
            self._past.note_publishers()


def _clock_ns() -> int:
    """Return how far the clock is ahead of one that is never set."""
    return time.time_ns() - time.monotonic_ns()
