"""Gaps: how many samples of each sender were lost on the way, by their numbers."""

from __future__ import annotations

from collections import OrderedDict

SENDERS_MAX = 10_000


class Gaps:
    """Counts what is missing between the numbers of each sender's samples.

    A number that is not above the last one (a sender that began anew, or came late) is no gap.
    Only the last senders are remembered: a peer that invents one for every sample costs no more.
    """

    def __init__(self) -> None:
        self._last: OrderedDict[bytes, int] = OrderedDict()
        self.lost = 0

    def count(self, gid: bytes, sequence: int) -> int:
        """Take note of a sample, and give how many of its sender are missing before it."""
        last = self._last.get(gid)
        self._last[gid] = sequence
        if last is None:
            if len(self._last) > SENDERS_MAX:
                self._last.popitem(last=False)
            return 0
        missing = max(0, sequence - last - 1)
        self.lost += missing
        return missing
