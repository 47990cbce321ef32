"""Gaps: how many samples of each sender were lost on the way, by their numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.ros.attachment import Attachment

SENDERS_MAX = 10_000
LATE_MAX = 256
"""How many missing samples of one sender may still come late."""


@dataclass(slots=True)
class _Sender:
    """Where a sender is: its highest number, when that was sent, and what may still come."""

    last: int
    last_ns: int
    missing: dict[int, None] = field(default_factory=dict[int, None])


class Gaps:
    """Counts what is missing between the numbers of each sender's samples.

    A sample that comes late, by its number and its time, is missing no more. One with a lower
    number that was sent later is of a sender that began anew, which is no gap. Only the last
    senders are remembered: a peer that invents one for every sample costs no more.
    """

    def __init__(self) -> None:
        self._senders: dict[bytes, _Sender] = {}
        self.lost = 0

    def count(self, attachment: Attachment) -> int:
        """Take note of a sample, and give how many of its sender are missing before it."""
        sequence, source_time_ns, gid = attachment
        sender = self._senders.get(gid)
        if sender is None:
            self._meet(gid, _Sender(sequence, source_time_ns))
            return 0
        missing = sequence - sender.last - 1
        if not missing:
            sender.last, sender.last_ns = sequence, source_time_ns
            return 0
        if missing < 0 and source_time_ns <= sender.last_ns:
            self._came_late(sender, sequence)
            return 0
        if missing > 0:
            self._miss(sender, sequence)
        else:
            sender.missing.clear()
        sender.last, sender.last_ns = sequence, source_time_ns
        return max(0, missing)

    def _meet(self, gid: bytes, sender: _Sender) -> None:
        self._senders[gid] = sender
        if len(self._senders) > SENDERS_MAX:
            del self._senders[next(iter(self._senders))]

    def _miss(self, sender: _Sender, sequence: int) -> None:
        """Count what lies between, and remember the newest of it."""
        self.lost += sequence - sender.last - 1
        first = max(sender.last + 1, sequence - LATE_MAX)
        sender.missing |= dict.fromkeys(range(first, sequence))
        while len(sender.missing) > LATE_MAX:
            del sender.missing[next(iter(sender.missing))]

    def _came_late(self, sender: _Sender, sequence: int) -> None:
        if sequence in sender.missing:
            del sender.missing[sequence]
            self.lost -= 1
