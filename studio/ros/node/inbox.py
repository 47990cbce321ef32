"""Inbox: samples between the drain and whoever takes them, the newest of them kept."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from studio.ros.attachment import Attachment


class RawSample(NamedTuple):
    """A sample as it came; one is made for each, for which a tuple takes the least time.

    `payload` is CDR, `attachment` tells number, time and sender, `received_ns` when it was taken
    out of the ring, since the Unix epoch.
    """

    payload: bytes
    attachment: Attachment
    received_ns: int


BLINK_NS = 20_000_000
SAMPLES_MAX = 4_096


class Inbox:
    """Keeps the last `depth` samples, and those of the last blink of 20 ms.

    The drain looks every 2 ms and threads take turns: what came a moment ago is no backlog,
    however fast its sender is, so that a reader that keeps up loses nothing. A depth of 1 means
    the newest and nothing else.

    Attributes:
        samples: Those that wait, the oldest first; whoever takes one out takes it from the left.
        overwritten: How many fell out.
    """

    def __init__(self, depth: int) -> None:
        self._depth = depth
        self._most = max(depth, SAMPLES_MAX)
        self._blink_ns = BLINK_NS if depth > 1 else 0
        self.samples: deque[RawSample] = deque()
        self._lock = threading.Lock()
        self.overwritten = 0

    def __len__(self) -> int:
        return len(self.samples)

    def post(self, samples: list[RawSample]) -> None:
        """Put in what came since the last look; what is too old falls out."""
        with self._lock:
            waiting = self.samples
            waiting.extend(samples)
            since_ns = waiting[-1].received_ns - self._blink_ns if waiting else 0
            while len(waiting) > self._depth and (
                waiting[0].received_ns <= since_ns or len(waiting) > self._most
            ):
                waiting.popleft()
                self.overwritten += 1

    def take(self) -> RawSample | None:
        """Take the oldest out."""
        try:
            return self.samples.popleft()
        except IndexError:
            return None

    def take_all(self) -> list[RawSample]:
        """Take all out, the oldest first."""
        with self._lock:
            taken = list(self.samples)
            self.samples.clear()
        return taken
