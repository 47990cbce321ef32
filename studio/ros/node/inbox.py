"""Inbox: samples between the drain and whoever takes them, the newest of them kept."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.ros.attachment import Attachment


@dataclass(frozen=True, slots=True)
class RawSample:
    """A sample as it came.

    `payload` is CDR, `attachment` tells number, time and sender, `received_ns` when it was taken
    out of the ring, since the Unix epoch.
    """

    payload: bytes
    attachment: Attachment
    received_ns: int


class Inbox:
    """Keeps the last `depth` samples, and never fewer than came within one look of the drain.

    The drain looks every 2 ms: what came between two looks is no backlog, however fast its
    sender is, so that a reader that keeps up loses nothing.
    """

    def __init__(self, depth: int) -> None:
        self._depth = depth
        self._samples: deque[RawSample] = deque()
        self._lock = threading.Lock()
        self.overwritten = 0

    def __len__(self) -> int:
        return len(self._samples)

    def post(self, samples: list[RawSample]) -> None:
        """Put in what came since the last look; what is too old falls out."""
        with self._lock:
            self._samples.extend(samples)
            for _ in range(len(self._samples) - max(self._depth, len(samples))):
                self._samples.popleft()
                self.overwritten += 1

    def take(self) -> RawSample | None:
        """Take the oldest out."""
        try:
            return self._samples.popleft()
        except IndexError:
            return None
