"""StatePace: which joint states robot_state_publisher tells as TF, and which come too soon."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

_NANOSECONDS = 1_000_000_000


class StatePace:
    """Lets each joint through at most at a frequency, by the stamps of the messages.

    A message passes when its least recently told joint is due, and then whole, as upstream does it.

    Args:
        frequency_hz: Above 0.
        ignore_stamps: Let everything through.
    """

    def __init__(self, frequency_hz: float, *, ignore_stamps: bool = False) -> None:
        self.frequency_hz, self.ignore_stamps = frequency_hz, ignore_stamps
        self._told_ns: dict[str, int] = {}
        self._last_now_ns = 0

    def is_due(self, joints: Iterable[str], stamp_ns: int, now_ns: int) -> bool:
        """Whether a message is to be told; it counts as told then.

        A clock that went back, as a simulation's does when it begins anew, forgets all before.
        """
        if now_ns < self._last_now_ns:
            self._told_ns.clear()
        self._last_now_ns = now_ns
        names = tuple(joints)
        oldest_ns = min((self._told_ns.get(name, 0) for name in names), default=0)
        interval_ns = int(_NANOSECONDS / self.frequency_hz)
        if not self.ignore_stamps and stamp_ns < oldest_ns + interval_ns and oldest_ns:
            return False
        self._told_ns |= dict.fromkeys(names, stamp_ns)
        return True
